// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/guide.h"
#include "common/guiding/tree_update.h"

namespace treefarm {

/// Which distributions learn from a vertex.
struct RecordTarget {
    std::uint32_t region = Guide::kNoView;  ///< kNoView: none learns
    std::uint32_t view = Guide::kNoView;    ///< the distribution of the view, where there is one

    bool empty() const { return region == Guide::kNoView; }
    bool has_view() const { return view != Guide::kNoView; }
};

/// Where a record goes that the stochastic spatial filter has moved to `region`. One for a view goes to that of the
/// same direction there, if there is one.
template <bool kViews>
RecordTarget moved(const Guide& guide, std::uint32_t region, std::uint32_t outgoing_code, RecordTarget target) {
    target.region = region;
    if (kViews && target.has_view()) {
        const std::uint32_t view = guide.view(target.region, outgoing_code);
        if (view != Guide::kNoView) target.view = view;
    }
    return target;
}

/// Records of one work unit, appended in path order: added to the tree's sums afterwards, away from the path walk.
struct RecordLog {
    LargeTable<Record> records;         ///< with radiance
    std::vector<std::uint32_t> counts;  ///< recorded vertices per distribution, those without radiance included
    UpdateCaps caps;
    std::vector<Record> drafts;  ///< room for a path's records, of which only some are kept

    /// Empties the log, keeping its memory.
    void begin(std::uint32_t distributions) {
        records.clear();
        counts.assign(distributions, 0);
        caps = {};
    }
};

}  // namespace treefarm
