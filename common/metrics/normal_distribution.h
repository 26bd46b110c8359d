// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Probability that a standard normal variable exceeds |z| in magnitude.
double two_sided_p(double z);

/// Significance level of each of `tests` independent tests at which the chance of any false alarm is `significance`
/// (Sidak 1967): 1 - (1 - significance)^(1 / tests).
double sidak_level(double significance, std::uint64_t tests);

/// Value of |z| beyond which two_sided_p() is below `level`, in (0, 1).
double critical_z(double level);

}  // namespace treefarm
