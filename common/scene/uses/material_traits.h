// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// What a description asks of the surface that it describes. It goes by kinds, not by values: a black diffuse surface
/// has a diffuse lobe.
struct MaterialTraits {
    Lobes lobes;
    bool textured = false;       ///< what scatters is looked up; masks and normals do not count
    bool bumped = false;         ///< displacements tilt the shading normal
    bool normal_mapped = false;  ///< a normal map does
    bool masked = false;         ///< the geometry's business, not the BSDF's
    bool twosided = false;
    bool own_back = false;     ///< twosided with another material on the back
    bool microfacets = false;  ///< a rough surface
    bool anisotropic = false;  ///< needs tangents
    bool blended = false;
    bool coated = false;  ///< plastic

    MaterialTraits& operator|=(const MaterialTraits& other);
    bool operator==(const MaterialTraits&) const = default;
    /// Texture coordinates, tangents or both must be known where it is hit.
    bool needs_surface_detail() const { return textured || bumped || normal_mapped || anisotropic; }
};

/// Traits of a material with those that it is made of: the parts of a blend, a twosided one's back. Bumps of the parts
/// count, masks do not: they are the shape's own material's.
MaterialTraits material_traits(const Scene& scene, std::int32_t material);

/// Traits of a material alone, without what it is made of.
MaterialTraits own_traits(const Material& material);

/// The union over the materials that shapes use.
MaterialTraits scene_traits(const Scene& scene);

/// Per material: shapes use it, directly or as a part of another.
std::vector<bool> used_materials(const Scene& scene);

/// All that shapes use is diffuse with a constant reflectance and the geometry's own normals, so that the cheap surface
/// kernel suffices. Masks do not matter; a twosided surface may not have another material on its back.
bool is_plainly_diffuse(const Scene& scene);

}  // namespace treefarm
