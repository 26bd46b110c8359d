#pragma once

#include <array>

#include "common/guiding/guide.h"
#include "common/math/warp_batch.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// A sampled direction at a surface.
struct ScatterSample {
    Vec3 local;  ///< in the shading frame
    Vec3 world;
    Rgb f_cos;                 ///< f |cos|
    float pdf;                 ///< per steradian, of the whole mixture; delta: the probability of the lobe
    float bsdf_pdf;            ///< of the BSDF alone
    float guide_pdf;           ///< of the tree alone, where it guides
    std::uint32_t code;        ///< Z-order code of the direction, where the tree is used
    std::uint32_t conversion;  ///< its number in the batch's conversions
    bool guided;               ///< drawn from the tree
    bool delta;                ///< of a lobe without density, which the guide cannot find
};

/// Density of a mixture that samples the BSDF with the probability `bsdf_fraction`, the guide otherwise. The guide
/// stands in for smooth lobes only: the delta lobes of a BSDF that has both are sampled by the BSDF, at bsdf_fraction
/// times their probability (Mueller et al. 2017, as their program does it).
inline float mixed_pdf(float bsdf_fraction, float bsdf_pdf, float guide_pdf) {
    return bsdf_fraction * bsdf_pdf + (1.0f - bsdf_fraction) * guide_pdf;
}

/// Directions whose codes are wanted, converted together by vector code.
class CodeBatch {
  public:
    void clear() { count_ = 0; }

    /// Returns the direction's number.
    std::uint32_t add(const Vec3& direction, std::uint32_t region) {
        directions_.set(count_, direction);
        regions_[count_] = region;
        return count_++;
    }

    void convert() { direction_to_code_batch(directions_, count_, codes_); }

    /// Fetches what the tree's densities of these directions need.
    void prefetch(const Guide& guide) const {
        for (std::uint32_t i = 0; i < count_; ++i)
            guide.prefetch_pdf(regions_[i], codes_[i]);
    }

    std::uint32_t operator[](std::size_t i) const { return codes_[i]; }

  private:
    std::uint32_t count_ = 0;
    DirectionBatch directions_;
    std::array<std::uint32_t, kDrawBatch> regions_;
    alignas(64) std::array<std::uint32_t, kDrawBatch> codes_;
};

/// The directions that a batch of paths takes at its surfaces, drawn from the BSDF's density or from
/// bsdf_fraction * p_BSDF + (1 - bsdf_fraction) * p_guide: first draw() for each path, then convert(), then complete()
/// for each. draw() and complete() agree by construction: the guide's part of a guided sample is the density of the
/// very cell it was drawn from. `kCoded` fills codes also where nothing guides. A surface has bsdf(), frame() and wo().
template <bool kGuided, bool kCoded>
class ScatterBatch {
  public:
    void clear() {
        codes_.clear();
        place_count_ = 0;
    }

    /// random[0] chooses BSDF or guide, [1] the BSDF's lobe or the guide's cell, [2] and [3] the place; `cosine` is
    /// that place warped to the cosine hemisphere. False if there is no direction.
    template <class Surface>
    bool draw(const Surface& surface, const Guide& guide, std::uint32_t region, float bsdf_fraction, const Draw& random,
              const Vec3& cosine, ScatterSample& s) {
        s.guided = kGuided && !(to_unit(random[0]) < bsdf_fraction);
        s.guide_pdf = 0.0f;
        if (kGuided && s.guided) {
            const Guide::Place place = guide.sample_place(region, random[1], random[2], random[3]);
            s.code = place.code;
            s.guide_pdf = place.pdf;
            s.delta = false;
            s.conversion = place_count_;
            places_x_[place_count_] = place.at.x;
            places_y_[place_count_++] = place.at.y;
            return true;
        }
        const Vec2 place(to_unit(random[2]), to_unit(random[3]));
        const BsdfSample b = surface.bsdf().sample(surface.wo(), {to_unit(random[1]), place, cosine});
        if (!(b.pdf > 0.0f)) return false;
        s.local = b.wi;
        s.world = surface.frame().to_world(b.wi);
        s.f_cos = b.f_cos;
        s.bsdf_pdf = b.pdf;
        s.delta = b.delta;
        if (kCoded && !b.delta) s.conversion = codes_.add(s.world, region);
        return true;
    }

    /// Codes of the BSDFs' directions, directions of the guide's places.
    void convert(const Guide& guide) {
        if constexpr (kCoded) codes_.convert();
        if constexpr (kGuided) {
            codes_.prefetch(guide);
            square_to_direction_batch(places_x_, places_y_, place_count_, directions_);
        }
    }

    /// Value and density of what was drawn; pdf or f_cos may be 0.
    template <class Surface>
    void complete(const Surface& surface, const Guide& guide, std::uint32_t region, float bsdf_fraction,
                  ScatterSample& s) const {
        if (kGuided && s.guided) {
            s.world = directions_[s.conversion];
            s.local = surface.frame().to_local(s.world);
            const BsdfValue b = surface.bsdf().value(surface.wo(), s.local);
            s.f_cos = b.f_cos;
            s.bsdf_pdf = b.pdf;
        } else if (kCoded && !s.delta) {
            s.code = codes_[s.conversion];
            if constexpr (kGuided) s.guide_pdf = guide.pdf(region, s.code);
        }
        s.pdf = s.bsdf_pdf;
        if constexpr (kGuided)
            s.pdf = s.delta ? s.bsdf_pdf * bsdf_fraction : mixed_pdf(bsdf_fraction, s.bsdf_pdf, s.guide_pdf);
    }

  private:
    CodeBatch codes_;
    std::uint32_t place_count_ = 0;
    alignas(64) std::array<float, kDrawBatch> places_x_, places_y_;
    DirectionBatch directions_;
};

}  // namespace treefarm
