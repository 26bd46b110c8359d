// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/guides/list_walk.h"

namespace treefarm {

/// Path-walk adapter of a guide whose directional distributions depend on the region alone (docs/use/write-a-guide.md):
///
///   sample_square(std::uint32_t region, std::uint32_t pick, std::uint32_t u0, std::uint32_t u1) const
///           three uniform numbers; a point `at` of the direction square, its Z-order `code`, and the density `pdf` per
///           steradian of its direction, above 0
///   float pdf(std::uint32_t region, std::uint32_t code) const
///           density per steradian of the direction with this code, equal to the one that sample_square() returned
///   float radiance(std::uint32_t region, std::uint32_t code) const
///           mean radiance learned for it; negative: unknown
template <class S>
struct PlainWalk : ListWalk<TechniqueList<S>> {
    template <class Target, class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules& rules, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const float value = l.pdf > 0.0f ? rules.target_value(l.radiance, l.pdf) : 0.0f;
        return PlainWalk::record(target.region, rounding, value, l, l.bins[0], log, end);
    }
};

}  // namespace treefarm
