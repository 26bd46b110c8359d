// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Adds a value to a sum, limited to the largest integer. Returns whether the sum fitted.
inline bool add_saturating(std::uint64_t& sum, std::uint64_t value) {
    const bool fits = value <= ~sum;
    sum = fits ? sum + value : ~std::uint64_t{0};
    return fits;
}

}  // namespace treefarm
