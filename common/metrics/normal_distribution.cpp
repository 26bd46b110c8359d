// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/normal_distribution.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace treefarm {

double two_sided_p(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double sidak_level(double significance, std::uint64_t tests) {
    return -std::expm1(std::log1p(-significance) / static_cast<double>(std::max<std::uint64_t>(1, tests)));
}

double critical_z(double level) {
    return boost::math::quantile(boost::math::complement(boost::math::normal(), 0.5 * level));
}

}  // namespace treefarm
