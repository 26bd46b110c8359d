// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Advice in place of an option that other renderers have and this one has not, or has as a key of the job: "--frames"
/// -> "start one render for each frame ...". "" if nothing is known of it.
std::string option_advice(const std::string& option, const std::string& command);

}  // namespace treefarm
