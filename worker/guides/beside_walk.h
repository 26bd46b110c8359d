// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/beside/beside.h"
#include "worker/guides/list_walk.h"

namespace treefarm {

/// Technique of the guide beside another one, in a BesideSampler `S`. Its sampler draws points of the direction square,
/// or directions:
///
///   sample_square(region, pick, u0, u1), pdf(region, code)     as for PlainWalk; or
///   sample_direction(region, random), pdf(region, direction)   a `direction` with its `pdf`, as a function of a vector
template <class S>
struct BesideTechnique {
    using Other = typename S::Other;
    using Local = LocalDistribution<BesideTechnique>;
    static constexpr bool kOnSquare = requires(const Other& other) { other.sample_square(0u, 0u, 0u, 0u); };

    template <class Surface>
    static void find(const S& guide, const Surface& surface, const Vec3& position, const Vec3&, std::uint32_t,
                     std::uint32_t&, Local& here) {
        here.distribution = surface.smooth() ? guide.first() + guide.beside().region(position) : kNoDistribution;
    }
    static float fraction(const S& guide, const Local& here) { return 1.0f - guide.bsdf_fraction(here.distribution); }
    static float least_bsdf_fraction(const S&, const Local&) { return 0.0f; }

    static auto sample(const S& guide, const Local& here, const Draw& random) {
        if constexpr (kOnSquare)
            return guide.beside().sample_square(region(guide, here), random[1], random[2], random[3]);
        else
            return guide.beside().sample_direction(region(guide, here), random);
    }
    template <class Direction>
    static float pdf(const S& guide, const Local& here, const Direction& direction) {
        return guide.beside().pdf(region(guide, here), direction);
    }
    /// Distribution of a vertex moved to another region: it keeps that of its position.
    static std::uint32_t moved(const S&, std::uint32_t, std::uint32_t, std::uint32_t distribution) {
        return distribution;
    }

    static void prefetch(const S&, const Local&, std::uint32_t) {}
    static void prefetch_more(const S&, const Local&, std::uint32_t) {}
    static void prefetch_pdf(const S& guide, const Local& here, std::uint32_t code) {
        guide.beside().prefetch_pdf(region(guide, here), code);
    }
    static void prefetch_pdf_more(const S& guide, const Local& here, std::uint32_t code) {
        guide.beside().prefetch_pdf_cell(region(guide, here), code);
    }

  private:
    static std::uint32_t region(const S& guide, const Local& here) { return here.distribution - guide.first(); }
};

/// Path-walk adapter of a guide with walk `First` and a technique of another guide beside it; `S`: BesideSampler.
template <class First, class S>
struct BesideWalk : ListWalk<typename First::List::template With<S, BesideTechnique<S>>> {
    static constexpr std::size_t kLast = First::List::kFurther;

    static void prefetch(const S& guide, std::uint32_t region, std::uint32_t pick) {
        First::prefetch(guide, region, pick);
    }
    static void prefetch_more(const S& guide, std::uint32_t region, std::uint32_t pick) {
        First::prefetch_more(guide, region, pick);
    }
    template <class At, class Drawn>
    static float radiance(const S& guide, const At& guidance, const Drawn& s) {
        return First::radiance(guide, guidance, s);
    }

    /// Adds the records of the first guide, and one of the incident radiance for the other.
    template <class Target, class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules& rules, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        end = First::teach(rules, rounding, target, l, log, end);
        if (target.further[kLast] == kNoDistribution) return end;
        const float value = l.pdf > 0.0f ? rules.target_value(l.radiance, l.pdf) : 0.0f;
        return BesideWalk::record(target.further[kLast], scrambled(rounding, kOfBeside + kLast), value, l,
                                  l.bins[kLast + 1], log, end);
    }

  private:
    static constexpr std::uint32_t kOfBeside = 10;  ///< salt: see SdTreeWalk
};

}  // namespace treefarm
