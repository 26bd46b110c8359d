// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Limit of a count that a message may claim: sums over all messages of a render fit 64 bits.
inline constexpr std::uint64_t kMostClaim = std::uint64_t{1} << 48;

/// Adds a value to a sum, limited to the largest integer. Returns whether the sum fitted.
inline bool add_saturating(std::uint64_t& sum, std::uint64_t value) {
    const bool fits = value <= ~sum;
    sum = fits ? sum + value : ~std::uint64_t{0};
    return fits;
}

}  // namespace treefarm
