// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Counts of tracing some units: exact sums.
struct TraceCounts {
    std::uint64_t paths = 0;
    std::uint64_t nonzero_paths = 0;  ///< paths with any radiance
    std::uint64_t rays = 0;           ///< closest-hit rays
    std::uint64_t shadow_rays = 0;
    std::uint64_t vertices = 0;         ///< surface vertices at which a direction was sampled
    std::uint64_t records = 0;          ///< vertices recorded for the guide
    std::uint64_t split_path_rays = 0;  ///< rays of split paths, within `rays`
    std::uint64_t invalid_samples = 0;
};

}  // namespace treefarm
