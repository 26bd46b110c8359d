#pragma once

#include "worker/shading/bsdf_sample.h"

namespace treefarm {

struct Bsdf;

/// A BSDF in a frame of its own: about a tilted normal (bump and normal maps), or along the surface's tangents
/// (anisotropy). Directions that the surface and the tilted one see on different sides carry nothing: no light leaks.
struct OrientedBsdf {
    const Bsdf* inner = nullptr;
    Vec3 s{1.0f, 0.0f, 0.0f}, t{0.0f, 1.0f, 0.0f}, n{0.0f, 0.0f, 1.0f};  ///< orthonormal; wo . n > 0

    LobeBits lobes() const;
    float refraction() const;
    inline BsdfValue value(const Vec3& wo, const Vec3& wi) const;
    inline BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const;

    Vec3 to_inner(const Vec3& w) const { return {dot(w, s), dot(w, t), dot(w, n)}; }
    Vec3 to_outer(const Vec3& w) const { return s * w.x + t * w.y + n * w.z; }
};

}  // namespace treefarm
