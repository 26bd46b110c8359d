// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Probability that a standard normal variable lies further from 0 than |z|.
double two_sided_p(double z);

/// Level of one of `tests` independent tests such that the chance of any false alarm is `significance`
/// (Sidak 1967): 1 - (1 - significance)^(1 / tests).
double sidak_level(double significance, std::uint64_t tests);

/// |z| beyond which two_sided_p falls below `level`, in (0, 1).
double critical_z(double level);

}  // namespace treefarm
