// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace treefarm {

/// Seconds between two results of a worker: those that the job asks for, or more where workers splat to so many pixels
/// (0: none) that their results would take over 30 % of a coordinator's gigabit Ethernet. A worker that is lost takes
/// so much with it; no bit of an image depends on it.
inline double result_seconds(double asked, std::uint32_t splat_pixels, std::size_t workers) {
    constexpr double kBytesPerSecond = 0.3 * 117e6;
    constexpr double kBytesPerPixel = 2 * 18;  // both halves of a pixel that was touched, roughly
    return std::max(asked, static_cast<double>(workers) * splat_pixels * kBytesPerPixel / kBytesPerSecond);
}

}  // namespace treefarm
