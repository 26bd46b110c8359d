// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/job_keys.h"

namespace treefarm {

/// The keys of job_keys() that begin with "guiding.".
std::vector<JobKey> guiding_keys();

}  // namespace treefarm
