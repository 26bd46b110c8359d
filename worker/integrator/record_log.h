#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/tree_update.h"

namespace treefarm {

/// What one work unit taught, appended in path order: added to the tree's sums afterwards, away from the path walk.
struct RecordLog {
    std::vector<Record> records;        ///< those with radiance
    std::vector<std::uint32_t> counts;  ///< recorded vertices per region, those without radiance included
    UpdateCaps caps;

    /// Empties the log, keeping its memory.
    void begin(std::uint32_t regions) {
        records.clear();
        counts.assign(regions, 0);
        caps = {};
    }
};

}  // namespace treefarm
