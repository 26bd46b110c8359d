// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/guiding/statistics/cell_sums.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Settings of the quantity that records hold.
struct RecordRules {
    GuidingTarget target = GuidingTarget::radiance;
    ViewRecords view_records = ViewRecords::product;
    /// beta in [0, 1]: fraction of a record that is the learned value of the next vertex's region
    float bootstrap = 0.0f;

    /// Recorded quantity: L / p, or L^2 / p for the second moment.
    float target_value(float radiance, float pdf) const {
        return finite(target == GuidingTarget::variance ? radiance * (radiance / pdf) : radiance / pdf);
    }
    /// Value clamped to the largest float: the sums cap it, and count that.
    static float finite(float value) { return std::min(value, std::numeric_limits<float>::max()); }
};

/// Writes a record at `end`, and returns the new end; a record of 0 does not advance it. Without a branch, since it
/// would be unpredictable.
inline Record* append_record(Record record, Record* end) {
    record.value = record.value > 0.0f ? record.value : 0.0f;  // also NaN
    record.reflected = record.reflected > 0.0f ? record.reflected : 0.0f;
    *end = record;
    return end + (std::max(record.value, record.reflected) > 0.0f);
}

/// Records of one work unit, in path order; added to the guide's sums afterwards, outside of the path walk.
struct RecordLog {
    LargeTable<Record> records;         ///< records with radiance
    std::vector<std::uint32_t> counts;  ///< recorded vertices per distribution, those without radiance included
    UpdateCaps caps;
    std::vector<NextEventSums> next_event;  ///< per region, if the pass decides on next event
    std::vector<Record> drafts;             ///< buffer of one path's records, of which only some are kept

    /// Clears the log, keeping its memory. `regions`: number of regions whose direct light is summed.
    void begin(std::uint32_t distributions, std::uint32_t regions = 0) {
        records.clear();
        counts.assign(distributions, 0);
        caps = {};
        next_event.assign(regions, {});
    }
};

}  // namespace treefarm
