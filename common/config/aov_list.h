// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/film/aov.h"

namespace treefarm {

/// The AOVs in a list of names with commas between: "albedo, normal, near:depth" asks for the third as layer "near".
/// If the text is no such list the result is empty and `why` says why, and what to do.
std::vector<AovRequest> parse_aovs(const std::string& text, std::string& why);

/// The AOVs that a job asks for.
std::vector<AovRequest> aov_requests(const Job& job);

/// One entry of the list: "depth", or "near:depth".
std::string aov_text(const AovRequest& request);

}  // namespace treefarm
