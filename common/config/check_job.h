// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"

namespace treefarm {

/// Greatest rr_depth of a job without a depth limit: later roulette would let light between white walls go on
/// practically forever.
inline constexpr int kLatestRoulette = 10'000;

/// Checks rules that involve several keys. Throws InputError.
void check_job(const Job& job);

}  // namespace treefarm
