// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/film/aov.h"

namespace treefarm {

/// The AOVs in a comma-separated list: "albedo, normal, near:depth" requests depth as a layer named "near". If the text
/// is malformed, the result is empty and `why` holds the reason and the cure.
std::vector<AovRequest> parse_aovs(const std::string& text, std::string& why);

/// The AOVs that a job requests.
std::vector<AovRequest> aov_requests(const Job& job);

/// Entry of the list for a request: "depth", or "near:depth".
std::string aov_text(const AovRequest& request);

}  // namespace treefarm
