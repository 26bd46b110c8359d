// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/qtable/qtable.h"
#include "worker/guides/plain_walk.h"

namespace treefarm {

/// The table of radiances as the path walk uses it: a cell learns the mean of what its visits brought, so a vertex
/// teaches the radiance itself, not over its density, and teaches also where there was none. What next event found in
/// kick-start passes was drawn otherwise, is half of a weighted sum and no visit: the table does without.
struct QTableWalk : PlainWalk<QTableSampler> {
    template <class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules&, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const bool visit = l.pdf > 0.0f && l.of_mixture;
        const float value = visit && l.radiance > 0.0f ? RecordRules::finite(l.radiance) : 0.0f;
        const float mixture = l.of_mixture && l.reflected > 0.0f ? l.reflected : 0.0f;
        log.counts[target.region] += visit;
        *end = {target.region, l.direction, rounding, value, mixture, l.bins, visit};
        return end + (visit || mixture > 0.0f);
    }
};

}  // namespace treefarm
