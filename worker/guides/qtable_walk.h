// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/qtable/qtable.h"
#include "worker/guides/plain_walk.h"

namespace treefarm {

/// Path-walk adapter of the table of radiances. A cell learns the mean over its visits, so a vertex teaches the
/// radiance itself, not divided by its density, and zeros count. Next-event samples of kick-start passes are drawn with
/// another density and are half of a weighted sum, so the table ignores them.
struct QTableWalk : PlainWalk<QTableSampler> {
    template <class Target, class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules&, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const bool visit = l.pdf > 0.0f && l.of_mixture;
        const float value = visit && l.radiance > 0.0f ? RecordRules::finite(l.radiance) : 0.0f;
        const float mixture = l.of_mixture && l.reflected > 0.0f ? l.reflected : 0.0f;
        log.counts[target.region] += visit;
        *end = {target.region, code_of(l.direction), rounding, value, mixture, l.bins[0], visit};
        return end + (visit || mixture > 0.0f);
    }
};

}  // namespace treefarm
