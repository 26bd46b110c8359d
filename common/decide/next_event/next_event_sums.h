// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/evidence/block_shape.h"
#include "common/math/saturating.h"

namespace treefarm {

/// Possible numbers n of light samples per vertex; below 1, n is a probability. A code is an index into this array.
inline constexpr std::array<float, 3> kNextEventSamples = {1.0f, 0.25f, 0.0625f};

/// Code of the n nearest to `mean`, in [0, 1], by ratio.
inline std::uint8_t next_event_code(double mean) {
    std::size_t code = kNextEventSamples.size() - 1;
    const auto n = [](std::size_t of) { return static_cast<double>(kNextEventSamples[of]); };
    while (code > 0 && mean * mean > n(code) * n(code - 1))
        --code;
    return static_cast<std::uint8_t>(code);
}

/// Number of multiples of `every` among `count` integers from `first` on.
inline std::uint64_t multiples_in(std::uint64_t first, std::uint64_t count, std::uint64_t every) {
    const auto before = [every](std::uint64_t number) { return (number + every - 1) / every; };
    return before(first + count) - before(first);
}

/// Statistics of next event, as integers. From kNextEventMoments on there is a sum for each n: the second moment that
/// direct light would have with it, relative to the square of the mean light around the pixel.
enum NextEventSum : std::size_t {
    kNextEventAsked,   ///< vertices that may sample an emitter with extent
    kNextEventDrawn,   ///< vertices at which one was sampled
    kNextEventTraced,  ///< samples that needed a shadow ray
    kNextEventMoments,
    kNextEventSpread = kNextEventMoments + kNextEventSamples.size(),  ///< squares of the last moment minus the first
    kNextEventSums,
};
struct NextEventSums : std::array<std::uint64_t, kNextEventSums> {
    static constexpr BlockShape kBlock{"next event", "vertices, next_event_unit()", BlockKind::sums, 1, kNextEventSums};
    template <class Sums, class Visit>
    static constexpr void each(Sums& sums, Visit visit) {
        for (auto& sum : sums)
            visit(sum);
    }
    void add(const NextEventSums& other) {
        for (std::size_t i = 0; i < kNextEventSums; ++i)
            add_saturating((*this)[i], other[i]);
    }
};

/// Value of one unit of a sum.
inline constexpr double next_event_unit(std::size_t sum) {
    return sum < kNextEventMoments ? 1.0 : sum < kNextEventSpread ? 0x1p-16 : 0x1p-8;
}

/// Adds a value to a sum in its units, rounded up or down by the uniform bits `random`, so that the expectation is
/// exact; at most 2^40 units.
inline void add_rounded(NextEventSums& sums, std::size_t sum, double value, std::uint32_t random) {
    constexpr double kMost = 0x1p40;
    const double units = value / next_event_unit(sum) + static_cast<double>(random) * 0x1p-32;
    if (units >= 1.0) add_saturating(sums[sum], static_cast<std::uint64_t>(std::min(units, kMost)));
}

/// Adds a sample of direct light. `relative`: its contribution over the mean light around the pixel, under the balance
/// heuristic of one scattered direction and `n` emitter samples with the given densities. Whatever `n` was, the
/// expectation of each sum is the second moment with the sum's own n: the integral of the squared contribution over the
/// combined density (Grittmann et al. 2022, "Efficiency-aware multiple importance sampling").
inline void add_direct_light(NextEventSums& sums, float relative, float scatter_pdf, float light_pdf, float n,
                             std::uint32_t random) {
    const double square = static_cast<double>(relative) * static_cast<double>(relative);
    const auto s = static_cast<double>(scatter_pdf), l = static_cast<double>(light_pdf);
    const double density = s + static_cast<double>(n) * l;
    if (!(square > 0.0 && density > 0.0 && std::isfinite(square) && std::isfinite(density))) return;
    double first = 0, last = 0;
    for (std::size_t choice = 0; choice < kNextEventSamples.size(); ++choice) {
        last = square * density / (s + static_cast<double>(kNextEventSamples[choice]) * l);
        if (choice == 0) first = last;
        add_rounded(sums, kNextEventMoments + choice, last, random);
    }
    add_rounded(sums, kNextEventSpread, (last - first) * (last - first), random);
}

}  // namespace treefarm
