#pragma once

#include <cstdint>

#include "common/scene/scene.h"
#include "worker/shading/diffuse.h"

namespace treefarm {

/// How a surface scatters, ready for the path walk: a closed set told apart by `kind`, no virtual call. Directions are
/// in the shading frame, `wo` to where light goes, `wi` to where it comes from.
struct Bsdf {
    enum class Kind : std::uint8_t { black, diffuse };

    Kind kind = Kind::black;
    bool twosided = false;
    Rgb reflectance{0.0f};
};

/// What a material is to the walk; kNone (a shape without material) is black.
Bsdf make_bsdf(const Scene& scene, std::int32_t material);

/// A sampled direction; pdf 0 means that none was found (black, or seen from the back).
struct BsdfSample {
    Vec3 wi{0.0f};
    float pdf = 0;    ///< per steradian
    Rgb f_cos{0.0f};  ///< f |cos(wi)|
};

/// False where the BSDF is black for light leaving along wo, whatever wi: nothing need be sampled.
inline bool bsdf_reflects(const Bsdf& bsdf, const Vec3& wo) {
    return bsdf.kind != Bsdf::Kind::black && (wo.z > 0.0f || (bsdf.twosided && wo.z < 0.0f));
}

namespace detail {

/// Mirrors a direction to the side where the BSDF is defined.
inline Vec3 on_side(const Vec3& w, bool mirrored) {
    return mirrored ? Vec3(w.x, w.y, -w.z) : w;
}

}  // namespace detail

/// f |cos(wi)|, per steradian.
inline Rgb bsdf_eval(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
    const bool mirrored = bsdf.twosided && wo.z < 0.0f;
    switch (bsdf.kind) {
        case Bsdf::Kind::diffuse:
            return diffuse::eval(bsdf.reflectance, detail::on_side(wo, mirrored), detail::on_side(wi, mirrored));
        case Bsdf::Kind::black:
            break;
    }
    return Rgb(0.0f);
}

/// Density of bsdf_sample(), per steradian.
inline float bsdf_pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
    const bool mirrored = bsdf.twosided && wo.z < 0.0f;
    switch (bsdf.kind) {
        case Bsdf::Kind::diffuse:
            return diffuse::pdf(detail::on_side(wo, mirrored), detail::on_side(wi, mirrored));
        case Bsdf::Kind::black:
            break;
    }
    return 0.0f;
}

/// Draws wi for a given wo from two uniform numbers in [0, 1).
inline BsdfSample bsdf_sample(const Bsdf& bsdf, const Vec3& wo, const Vec2& u) {
    BsdfSample sample;
    if (!bsdf_reflects(bsdf, wo)) return sample;
    sample.wi = detail::on_side(diffuse::sample(u), wo.z < 0.0f);
    sample.pdf = bsdf_pdf(bsdf, wo, sample.wi);
    sample.f_cos = bsdf_eval(bsdf, wo, sample.wi);
    return sample;
}

}  // namespace treefarm
