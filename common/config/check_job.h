// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"

namespace treefarm {

/// From this depth on roulette must play where no depth limit ends paths: light between white walls would go on
/// forever.
inline constexpr int kLatestRoulette = 10'000;

/// Checks what no single key can see. Throws InputError.
void check_job(const Job& job);

}  // namespace treefarm
