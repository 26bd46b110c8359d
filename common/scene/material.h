#pragma once

#include <variant>

#include "common/scene/texture.h"

namespace treefarm {

/// How the normals of a rough surface's facets are distributed (Walter et al. 2007; thesis 2.8 to 2.12).
enum class Microfacets : std::uint8_t { smooth, ggx, beckmann };

struct Roughness {
    Microfacets distribution = Microfacets::smooth;
    /// What is smaller is raised to it, with a warning: a mirror to the eye, and its density still a float.
    static constexpr float kLeastAlpha = 1e-4f;

    FloatInput alpha_u{0.1f}, alpha_v{0.1f};  ///< along the tangent and the bitangent, above 0; equal: isotropic

    bool smooth() const { return distribution == Microfacets::smooth; }
    bool operator==(const Roughness&) const = default;
};

struct DiffuseMaterial {
    ColorInput reflectance{Rgb(0.5f)};  ///< albedo per channel, in [0, 1]
};

/// Metal: complex index of refraction eta + i k per channel, relative to what is outside. eta = 0, k = 1: a perfect
/// mirror.
struct ConductorMaterial {
    Rgb eta{0.0f}, k{1.0f};
    ColorInput specular_reflectance{Rgb(1.0f)};  ///< factor on what is reflected, in [0, 1]
    Roughness roughness;
};

/// A boundary between two transparent media. Radiance is scaled by 1/eta^2 when it enters the denser one.
struct DielectricMaterial {
    float eta =
        1.5046f;  ///< index of refraction of the side against the normal over that of the normal's side, above 0
    ColorInput specular_reflectance{Rgb(1.0f)}, specular_transmittance{Rgb(1.0f)};
    Roughness roughness;
};

/// A thin pane: reflections between its two surfaces summed up, transmission straight through.
struct ThinDielectricMaterial {
    float eta = 1.5046f;
    ColorInput specular_reflectance{Rgb(1.0f)}, specular_transmittance{Rgb(1.0f)};
};

/// A diffuse base under a dielectric coat.
struct PlasticMaterial {
    float eta = 1.49f;
    ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(1.0f)};
    bool nonlinear = false;  ///< colour shifts by interreflection inside the coat
    Roughness roughness;     ///< of the coat; isotropic
    /// A rough coat sends back to the base what its facets reflect once (Mitsuba 2 and 3), and the rest of what it does
    /// not let out is lost; otherwise it sends back all of that (0.6).
    bool single_return = false;
};

/// (1 - weight) * first + weight * second.
struct BlendMaterial {
    FloatInput weight{0.5f};
    std::int32_t first = kNone, second = kNone;  ///< indices in Scene::materials, below this material's own
};

/// Nothing is there: light passes straight on.
struct NullMaterial {};

/// A surface whose shading normal is tilted.
struct NormalDetail {
    std::int32_t bump = kNone;  ///< texture of displacements along the normal, in scene units
    float bump_scale = 1.0f;
    std::int32_t normal_map = kNone;  ///< bitmap that stores normals as (n + 1) / 2, in the tangent frame
    bool operator==(const NormalDetail&) const = default;
    bool any() const { return bump != kNone || normal_map != kNone; }
};

/// How a surface scatters.
///
/// The front is where the shading normal points. Opaque materials are black on their back unless `twosided`; those that
/// transmit (dielectric, thin dielectric, null, and blends with them) have both sides by nature and are never twosided.
struct Material {
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, ThinDielectricMaterial, PlasticMaterial,
                 BlendMaterial, NullMaterial>
        bsdf;
    bool twosided = false;      ///< the back scatters like the front, mirrored, or as `back` says
    std::int32_t back = kNone;  ///< twosided only: index of the material of the back, below this material's own
    /// Factors that textures take above 1 stay so (Mitsuba 2 and 3); otherwise they are scaled down (0.6).
    bool unlimited = false;
    FloatInput opacity{1.0f};  ///< probability that a ray meets the surface at all, in [0, 1]; of the shape's material
    NormalDetail detail;
    std::string name;
    Location where;

    bool masked() const { return opacity.varies() || opacity.value < 1.0f; }
};

}  // namespace treefarm
