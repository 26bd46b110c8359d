// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "worker/guides/technique_batch.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Path-walk adapter (worker/integrators/path/guide_walk.h) of a guide with a list of techniques. A walk derives from
/// it; it adds teach() and replaces what its guide does otherwise.
template <class Techniques>
struct ListWalk {
    using List = Techniques;
    using Sampler = typename List::Sampler;
    using Guidance = typename List::Guidance;
    using Scatter = typename List::Scatter;
    using Direction = typename List::Direction;
    using Bins = typename List::Bins;
    static constexpr bool kLocal = List::kFurther != 0;
    /// Z-order code of the outgoing direction, if a technique needs it.
    using Outgoing = std::uint32_t;

    using Further = std::array<std::uint32_t, List::kFurther>;
    template <class Values>
    static constexpr Values all(typename Values::value_type value) {
        Values values{};
        values.fill(value);
        return values;
    }

    /// Distributions that learn from a vertex.
    struct Target {
        std::uint32_t region = kNoDistribution;  ///< kNoDistribution: nothing learns
        [[no_unique_address]] Further further = all<Further>(kNoDistribution);

        bool empty() const { return region == kNoDistribution; }
    };

    template <bool kGuided, bool kConverts>
    using ScatterBatch = TechniqueBatch<List, kGuided, kConverts>;
    using LightBatch = CodeBatch<List>;

    static constexpr std::uint32_t kRecordsPerVertex = 1 + List::kFurther;
    static constexpr Bins kDeltaBins = all<Bins>(kMixtureBins - 1);

    static Guidance unguided() {
        Guidance guidance{};
        guidance.bsdf_fraction = 1.0f;
        return guidance;
    }

    template <bool kGuided, class Surface>
    static void localise(const Sampler& guide, const Surface& surface, const Vec3& position, const Vec3& outgoing,
                         Outgoing& code, Guidance& guidance) {
        List::template find<kGuided>(guide, surface, position, outgoing, code, guidance);
    }

    // Sampling's data is prefetched in steps, each addressed by the one before.
    static void prefetch(const Sampler&, std::uint32_t, std::uint32_t) {}
    static void prefetch_more(const Sampler&, std::uint32_t, std::uint32_t) {}
    static void prefetch_local(const Sampler& guide, const Guidance& guidance, std::uint32_t pick) {
        List::each([&]<std::size_t k, class T>() {
            const typename T::Local& here = guidance;
            if (here.here()) T::prefetch(guide, here, pick);
        });
    }
    static void prefetch_local_more(const Sampler& guide, const Guidance& guidance, std::uint32_t pick) {
        List::each([&]<std::size_t k, class T>() {
            const typename T::Local& here = guidance;
            if (here.here()) T::prefetch_more(guide, here, pick);
        });
    }

    /// Density of the mixture at a direction that was not drawn from it.
    static float pdf(const Sampler& guide, const Guidance& guidance, float bsdf_pdf, const Direction& direction) {
        const std::uint32_t code = code_of(direction);
        Vec3 world;
        if constexpr (!List::kOnSquare) world = direction.world;
        typename List::FurtherPdfs further{};
        const float guide_pdf = guide.pdf(guidance.region, code);
        List::each([&]<std::size_t k, class T>() {
            const typename T::Local& here = guidance;
            if (here.here()) further[k] = List::template pdf<T>(guide, guidance, code, world);
        });
        return List::mixed_pdf(guidance, bsdf_pdf, guide_pdf, further);
    }

    static Target target(const Guidance& guidance) {
        Target target;
        target.region = guidance.region;
        List::each([&]<std::size_t k, class T>() {
            const typename T::Local& here = guidance;
            target.further[k] = here.distribution;
        });
        return target;
    }
    /// Target moved to another `region`.
    static Target moved(const Sampler& guide, std::uint32_t region, [[maybe_unused]] Outgoing code, Target target) {
        target.region = region;
        List::each([&]<std::size_t k, class T>() {
            if (target.further[k] != kNoDistribution)
                target.further[k] = T::moved(guide, region, code, target.further[k]);
        });
        return target;
    }

    static Direction direction(const Scatter& s) {
        if constexpr (List::kOnSquare)
            return s.code;
        else
            return {s.code, s.world};
    }
    /// Direction of a point of the direction square.
    static Direction direction_at(const Vec2& square) {
        if constexpr (List::kOnSquare)
            return square_to_code(square);
        else
            return {square_to_code(square), square_to_direction(square)};
    }
    static Bins bins(const Guidance& guidance, const Scatter& s) { return List::bins(guidance, s); }

    /// Radiance that the region has learned for a direction.
    template <class At, class Drawn>
    static float radiance(const Sampler& guide, const At& guidance, const Drawn& s) {
        return guide.radiance(guidance.region, s.code);
    }

  protected:
    /// Writes a record for `distribution` at `end` and counts it; returns the new end.
    template <class Taught>
    [[gnu::always_inline]] static Record* record(std::uint32_t distribution, std::uint32_t rounding, float value,
                                                 const Taught& l, std::uint8_t bin, RecordLog& log, Record* end) {
        log.counts[distribution] += l.pdf > 0.0f;
        return append_record(
            {distribution, code_of(l.direction), rounding, value, l.of_mixture ? l.reflected : 0.0f, bin}, end);
    }
};

}  // namespace treefarm
