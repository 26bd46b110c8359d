// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Clusters of emitters that a region learns to choose between (worker/lights/light_tree.h).
inline constexpr int kLightClusters = 15;

/// Records are counted in units of 2^e such that a record of average value is 2^15 to 2^16 units: fine enough that
/// rounding adds nothing measurable, with a cap (2^40 units) 2^24 times the average.
inline constexpr int kMeanRecordBits = 16;

}  // namespace treefarm
