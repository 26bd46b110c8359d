// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Clusters of emitters that a region learns to choose between (worker/lights/light_tree.h).
inline constexpr int kLightClusters = 15;

/// Log2 of the size of a mean record: records are counted in units of 2^e such that the mean record is 2^15 to 2^16
/// units. That is fine enough for rounding to add no measurable noise, with a cap (2^40 units) at 2^24 times the mean.
inline constexpr int kMeanRecordBits = 16;

}  // namespace treefarm
