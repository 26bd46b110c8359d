// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/base/random_batch.h"
#include "common/guiding/regions/mixture.h"
#include "common/math/direction_map.h"
#include "worker/integrators/path/guide_walk.h"

namespace treefarm {

/// Path-walk adapter of a guide whose directional distributions depend on the region alone, and which samples one
/// direction at a time (docs/use/write-a-guide.md):
///
///   S::Sample sample(std::uint32_t region, const Draw& random) const   random[1] to [3] are uniform; a Sample has the
///                     direction, its Z-order code on the direction square, and its density per steradian, or 0 if the
///                     draw failed
///   float pdf(std::uint32_t region, std::uint32_t code) const          density per steradian of the direction with
///   this
///                     code, equal to the one that sample() returned
///   float radiance(std::uint32_t region, std::uint32_t code) const     mean radiance learned for it; negative: unknown
template <class S>
struct PlainWalk {
    using Sampler = S;
    struct Guidance {
        std::uint32_t region;
        float bsdf_fraction;
        void sample_bsdf_alone() { bsdf_fraction = 1.0f; }
    };
    struct Scatter : ScatterSample {
        std::uint32_t code;
    };
    using Direction = std::uint32_t;
    struct Target {
        std::uint32_t region = 0xffffffffu;
        bool empty() const { return region == 0xffffffffu; }
    };
    using Bins = std::uint8_t;
    struct Outgoing {};

    static constexpr bool kLocal = false;
    static constexpr std::uint32_t kRecordsPerVertex = 1;
    static constexpr Bins kDeltaBins = kMixtureBins - 1;

    /// Batch of directions sampled from bsdf_fraction * p_BSDF + (1 - bsdf_fraction) * p_guide.
    template <bool kGuided, bool kConverts>
    struct ScatterBatch {
        void clear() {}
        void convert(const Sampler&) {}

        template <class Surface>
        bool draw(const Surface& surface, const Sampler& guide, const Guidance& guidance, float technique,
                  const Draw& random, const Vec3& cosine, Scatter& s) {
            s.guided = kGuided && !(technique < guidance.bsdf_fraction);
            s.guide_pdf = 0.0f;
            if (kGuided && s.guided) {
                const auto drawn = guide.sample(guidance.region, random);
                s.world = drawn.direction;
                s.code = drawn.code;
                s.guide_pdf = drawn.pdf;
                s.delta = false;
                return drawn.pdf > 0.0f;
            }
            if (!draw_from_bsdf(surface, random, cosine, s)) return false;
            if (!s.delta) s.code = direction_to_code(s.world);
            return true;
        }

        template <class Surface>
        void complete(const Surface& surface, const Sampler& guide, const Guidance& guidance, Scatter& s) const {
            if (kGuided && s.guided) {
                s.local = surface.frame().to_local(s.world);
                const BsdfValue b = surface.bsdf().value(surface.wo(), s.local);
                s.f_cos = b.f_cos;
                s.bsdf_pdf = b.pdf;
            } else if (kGuided && !s.delta) {
                s.guide_pdf = guide.pdf(guidance.region, s.code);
            }
            s.pdf = s.bsdf_pdf;
            if (kGuided && s.delta) s.pdf *= guidance.bsdf_fraction;
            if (kGuided && !s.delta) s.pdf = mixed_pdf(guidance.bsdf_fraction, s.bsdf_pdf, s.guide_pdf);
            s.effective_pdf = s.pdf;
        }
    };

    /// Codes of next event's directions.
    class LightBatch {
      public:
        void clear() { count_ = 0; }
        void add(const Vec3& direction, const Guidance&) { codes_[count_++] = direction_to_code(direction); }
        void convert() {}
        void prefetch(const Sampler&) const {}
        void prefetch_more(const Sampler&) const {}
        std::uint32_t operator[](std::size_t i) const { return codes_[i]; }

      private:
        std::uint32_t count_ = 0;
        std::array<std::uint32_t, kDrawBatch> codes_;
    };

    static Guidance unguided() { return {0, 1.0f}; }
    static void prefetch(const Sampler&, std::uint32_t, std::uint32_t) {}
    static void prefetch_more(const Sampler&, std::uint32_t, std::uint32_t) {}

    static float pdf(const Sampler& guide, const Guidance& guidance, float bsdf_pdf, Direction code) {
        return mixed_pdf(guidance.bsdf_fraction, bsdf_pdf, guide.pdf(guidance.region, code));
    }

    static Target target(const Guidance& guidance) { return {guidance.region}; }
    static Target moved(const Sampler&, std::uint32_t region, Outgoing, Target) { return {region}; }
    static Direction direction(const Scatter& s) { return s.code; }
    /// Direction of a point of the direction square.
    static Direction direction_at(const Vec2& square) { return square_to_code(square); }
    static Bins bins(const Guidance&, const Scatter& s) { return mixture_bin(s.bsdf_pdf, s.guide_pdf); }
    static float radiance(const Sampler& guide, const Guidance& guidance, const Scatter& s) {
        return guide.radiance(guidance.region, s.code);
    }

    template <class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules& rules, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const bool smooth = l.pdf > 0.0f;
        const float value = smooth ? rules.target_value(l.radiance, l.pdf) : 0.0f;
        log.counts[target.region] += smooth;
        return append_record({target.region, l.direction, rounding, value, l.of_mixture ? l.reflected : 0.0f, l.bins},
                             end);
    }
};

}  // namespace treefarm
