// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/normal_distribution.h"

#include <algorithm>
#include <cmath>

namespace treefarm {

double two_sided_p(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double sidak_level(double significance, std::uint64_t tests) {
    return -std::expm1(std::log1p(-significance) / static_cast<double>(std::max<std::uint64_t>(1, tests)));
}

double critical_z(double level) {
    double low = 0.0, high = 40.0;  // p(40) is below the smallest double
    for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        (two_sided_p(middle) > level ? low : high) = middle;
    }
    return high;
}

}  // namespace treefarm
