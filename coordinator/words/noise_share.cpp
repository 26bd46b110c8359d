// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/noise_share.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace treefarm {

std::optional<double> noise_share(std::span<const Rgb64> variance, double part) {
    std::vector<double> values;
    values.reserve(variance.size());
    for (const Rgb64& v : variance)
        values.push_back(luminance(v));
    const double goal = part * std::accumulate(values.begin(), values.end(), 0.0);
    if (!(goal > 0)) return std::nullopt;
    // Bisection by rank: the largest up to `begin` are too few, those up to `end` are enough.
    auto begin = values.begin(), end = values.end();
    double before = 0;
    while (end - begin > 1) {
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, std::greater<>());
        const double sum = std::accumulate(begin, middle, before);
        if (sum >= goal) {
            end = middle;
        } else {
            before = sum;
            begin = middle;
        }
    }
    return static_cast<double>(end - values.begin()) / static_cast<double>(values.size());
}

}  // namespace treefarm
