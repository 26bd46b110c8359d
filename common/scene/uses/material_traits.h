// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Requirements of a material on the surface that it describes. They depend on kinds, not on values: a black diffuse
/// surface has a diffuse lobe.
struct MaterialTraits {
    Lobes lobes;
    bool textured = false;       ///< scattering depends on textures; masks and normals do not count
    bool bumped = false;         ///< displacements tilt the shading normal
    bool normal_mapped = false;  ///< a normal map tilts the shading normal
    bool masked = false;         ///< handled by the geometry, not by the BSDF
    bool twosided = false;
    bool own_back = false;     ///< twosided with another material on the back
    bool microfacets = false;  ///< a rough surface
    bool anisotropic = false;  ///< needs tangents
    bool blended = false;
    bool coated = false;  ///< plastic

    MaterialTraits& operator|=(const MaterialTraits& other);
    bool operator==(const MaterialTraits&) const = default;
    /// Whether texture coordinates, tangents or both are needed at a hit.
    bool needs_surface_detail() const { return textured || bumped || normal_mapped || anisotropic; }
};

/// Traits of a material and of those it consists of: the parts of a blend, a twosided one's back. Bumps of parts count;
/// masks do not, since only that of the shape's own material is used.
MaterialTraits material_traits(const Scene& scene, std::int32_t material);

/// Traits of a material without its parts.
MaterialTraits own_traits(const Material& material);

/// Union of the traits of all materials that shapes use.
MaterialTraits scene_traits(const Scene& scene);

/// Per material: whether shapes use it, directly or as a part of another.
std::vector<bool> used_materials(const Scene& scene);

/// Whether everything that shapes use is diffuse with a constant reflectance and the geometry's own normals, so that
/// the cheap surface kernel suffices. Masks do not matter; no twosided surface may have another material on its back.
bool is_plainly_diffuse(const Scene& scene);

}  // namespace treefarm
