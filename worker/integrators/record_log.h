// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Which distributions learn from a vertex.
struct RecordTarget {
    std::uint32_t region = SdTreeSampler::kNoView;  ///< kNoView: none learns
    std::uint32_t view = SdTreeSampler::kNoView;    ///< the distribution of the view, where there is one

    bool empty() const { return region == SdTreeSampler::kNoView; }
    bool has_view() const { return view != SdTreeSampler::kNoView; }
};

/// Where a record goes that the stochastic spatial filter has moved to `region`. One for a view goes to that of the
/// same direction there, if there is one.
template <bool kViews>
RecordTarget moved(const SdTreeSampler& guide, std::uint32_t region, std::uint32_t outgoing_code, RecordTarget target) {
    target.region = region;
    if (kViews && target.has_view()) {
        const std::uint32_t view = guide.view(target.region, outgoing_code);
        if (view != SdTreeSampler::kNoView) target.view = view;
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
