// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Records of one work unit, in path order; added to the guide's evidence afterwards, outside of the path walk. `R`:
/// the guide's type of record, trivially copyable.
template <class R>
struct RecordLogOf {
    using Record = R;

    LargeTable<R> records;              ///< records with radiance
    std::vector<std::uint32_t> counts;  ///< recorded vertices per distribution, those without radiance included
    UpdateCaps caps;
    std::vector<NextEventSums> next_event;  ///< per region, if the pass decides on next event
    std::vector<R> drafts;                  ///< buffer of one path's records, of which only some are kept

    /// Clears the log, keeping its memory. `regions`: number of regions whose direct light is summed.
    void begin(std::uint32_t distributions, std::uint32_t regions = 0) {
        records.clear();
        counts.assign(distributions, 0);
        caps = {};
        next_event.assign(regions, {});
    }
};

/// Log of guides whose directions have cells.
using RecordLog = RecordLogOf<Record>;

}  // namespace treefarm
