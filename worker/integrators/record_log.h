// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/guiding/statistics/cell_sums.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// What records are of.
struct RecordRules {
    GuidingTarget target = GuidingTarget::radiance;
    ViewRecords view_records = ViewRecords::product;
    float bootstrap = 0.0f;  ///< beta: which part of a record is what the next vertex's region has learned, [0, 1]

    /// L / p, or L^2 / p for the second moment.
    float target_value(float radiance, float pdf) const {
        return finite(target == GuidingTarget::variance ? radiance * (radiance / pdf) : radiance / pdf);
    }
    /// A value beyond float becomes the largest one: the sums cap it, and count that.
    static float finite(float value) { return std::min(value, std::numeric_limits<float>::max()); }
};

/// Writes a record at `end`, unless it has nothing to tell, which nothing would predict: no branch asks. Returns the
/// new end.
inline Record* append_record(Record record, Record* end) {
    record.value = record.value > 0.0f ? record.value : 0.0f;  // also NaN
    record.reflected = record.reflected > 0.0f ? record.reflected : 0.0f;
    *end = record;
    return end + (std::max(record.value, record.reflected) > 0.0f);
}

/// Records of one work unit, appended in path order: added to the guide's sums afterwards, away from the path walk.
struct RecordLog {
    LargeTable<Record> records;         ///< with radiance
    std::vector<std::uint32_t> counts;  ///< recorded vertices per distribution, those without radiance included
    UpdateCaps caps;
    std::vector<NextEventSums> next_event;  ///< per region, where next event is decided
    std::vector<Record> drafts;             ///< room for a path's records, of which only some are kept

    /// Empties the log, keeping its memory. `regions`: of which direct light is summed.
    void begin(std::uint32_t distributions, std::uint32_t regions = 0) {
        records.clear();
        counts.assign(distributions, 0);
        caps = {};
        next_event.assign(regions, {});
    }
};

}  // namespace treefarm
