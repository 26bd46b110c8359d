#pragma once

#include "common/base/random.h"
#include "common/guiding/guide.h"
#include "common/math/frame.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// A sampled direction at a surface; pdf 0 means none.
struct ScatterSample {
    Vec3 local{0.0f};  ///< in the shading frame
    Vec3 world{0.0f};
    Rgb f_cos{0.0f};         ///< f |cos|
    float pdf = 0;           ///< per steradian, of the whole mixture; delta: the probability of the lobe
    float bsdf_pdf = 0;      ///< of the BSDF alone
    float guide_pdf = 0;     ///< of the tree alone, where it guides
    std::uint32_t code = 0;  ///< Z-order code of the direction, if it was asked for
    bool delta = false;      ///< of a lobe without density, which the guide cannot find
};

/// Density of a mixture that samples the BSDF with the probability `bsdf_fraction`, the guide otherwise.
inline float mixed_pdf(float bsdf_fraction, float bsdf_pdf, float guide_pdf) {
    return bsdf_fraction * bsdf_pdf + (1.0f - bsdf_fraction) * guide_pdf;
}

/// The density from which directions are drawn at one surface point: the BSDF's, or
/// bsdf_fraction * p_BSDF + (1 - bsdf_fraction) * p_guide. sample() and pdf() agree by construction: the guide's part
/// of a guided sample is the density of the very cell it was drawn from. The guide stands in for smooth lobes only: the
/// delta lobes of a BSDF that has both are sampled by the BSDF, at bsdf_fraction times their probability (Mueller et
/// al. 2017, as their program does it).
template <class Bsdf, bool kGuided>
class GuidedSampling {
  public:
    /// `smooth`: the BSDF has a lobe that the guide can stand in for.
    GuidedSampling(const Bsdf& bsdf, const Frame& frame, const Vec3& wo, const Guide& guide, std::uint32_t region,
                   bool smooth)
        : bsdf_(bsdf), frame_(frame), wo_(wo), guide_(guide), region_(region) {
        if constexpr (kGuided)
            if (smooth) bsdf_fraction_ = guide.bsdf_fraction(region);
    }

    /// random[0] chooses BSDF or guide, [1] the BSDF's lobe or the guide's cell, [2] and [3] the place; `cosine` is
    /// that place warped to the cosine hemisphere. `need_code` fills `code`.
    ScatterSample sample(const Draw& random, const Vec3& cosine, bool need_code) const {
        ScatterSample s;
        if (!kGuided || to_unit(random[0]) < bsdf_fraction_) {
            const BsdfSample b =
                bsdf_.sample(wo_, {to_unit(random[1]), {to_unit(random[2]), to_unit(random[3])}, cosine});
            if (!(b.pdf > 0.0f)) return s;
            s.local = b.wi;
            s.world = frame_.to_world(b.wi);
            s.f_cos = b.f_cos;
            s.pdf = s.bsdf_pdf = b.pdf;
            if (b.delta) {
                s.delta = true;
                if constexpr (kGuided) s.pdf *= bsdf_fraction_;
                return s;
            }
            if (kGuided || need_code) s.code = direction_to_code(s.world);
            if constexpr (kGuided) {
                s.guide_pdf = guide_.pdf(region_, s.code);
                s.pdf = mix(b.pdf, s.guide_pdf);
            }
        } else {
            const Guide::Sample g = guide_.sample(region_, random[1], random[2], random[3]);
            s.world = g.direction;
            s.code = g.code;
            s.local = frame_.to_local(g.direction);
            const BsdfValue b = bsdf_.value(wo_, s.local);
            s.f_cos = b.f_cos;
            if (is_black(s.f_cos)) return s;
            s.bsdf_pdf = b.pdf;
            s.guide_pdf = g.pdf;
            s.pdf = mix(b.pdf, g.pdf);
        }
        return s;
    }

    /// 1 where the guide has no part.
    float bsdf_fraction() const { return bsdf_fraction_; }

  private:
    float mix(float bsdf, float guide) const { return mixed_pdf(bsdf_fraction_, bsdf, guide); }

    const Bsdf& bsdf_;
    const Frame& frame_;
    const Vec3& wo_;
    const Guide& guide_;
    std::uint32_t region_;
    float bsdf_fraction_ = 1.0f;
};

}  // namespace treefarm
