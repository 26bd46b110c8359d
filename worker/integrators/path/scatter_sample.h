// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// A sampled direction at a surface. A guide may add members.
struct ScatterSample {
    Vec3 local;  ///< in the shading frame
    Vec3 world;
    Rgb f_cos;            ///< f |cos|
    float pdf;            ///< per steradian, of the whole mixture; delta: the probability of the lobe
    float effective_pdf;  ///< pdf, or its replacement if one of several candidates was taken (candidates.h)
    float bsdf_pdf;       ///< of the BSDF alone
    float guide_pdf;      ///< of the region's learned distribution alone, if it guides
    bool guided;          ///< drawn by a technique of the guide, not from the BSDF
    bool delta;           ///< of a lobe without density, which the guide cannot sample
};

/// Density of a mixture that samples the BSDF with probability `bsdf_fraction` and the guide otherwise. The guide
/// replaces smooth lobes only: the delta lobes of a BSDF that has both are sampled by the BSDF, at bsdf_fraction times
/// their probability (as the program of Mueller et al. 2017 does).
inline float mixed_pdf(float bsdf_fraction, float bsdf_pdf, float guide_pdf) {
    return bsdf_fraction * bsdf_pdf + (1.0f - bsdf_fraction) * guide_pdf;
}

/// Draws a direction from the BSDF: random[1] chooses its lobe, [2] and [3] the point; `cosine` is that point warped to
/// the cosine hemisphere. False if there is no direction.
template <class Surface>
[[gnu::always_inline]] inline bool draw_from_bsdf(const Surface& surface, const Draw& random, const Vec3& cosine,
                                                  ScatterSample& s) {
    const Vec2 point(to_unit(random[2]), to_unit(random[3]));
    const BsdfSample b = surface.bsdf().sample(surface.wo(), {to_unit(random[1]), point, cosine});
    if (!(b.pdf > 0.0f)) return false;
    s.local = b.wi;
    s.world = surface.frame().to_world(b.wi);
    s.f_cos = b.f_cos;
    s.bsdf_pdf = b.pdf;
    s.delta = b.delta;
    return true;
}

}  // namespace treefarm
