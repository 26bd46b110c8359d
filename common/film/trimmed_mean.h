// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace treefarm {

/// Mean without the largest thousandth of the values, which must not be empty.
inline double trimmed_mean(std::vector<double> values) {
    const std::size_t kept = values.size() - values.size() / 1000;
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(kept);
    if (kept < values.size()) std::nth_element(values.begin(), end, values.end());
    return std::accumulate(values.begin(), end, 0.0) / static_cast<double>(kept);
}

}  // namespace treefarm
