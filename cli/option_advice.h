// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Advice for an option that other renderers have, and this one lacks or has as a job key: "--frames" -> "start one
/// render for each frame ...". "" if there is none.
std::string option_advice(const std::string& option, const std::string& command);

}  // namespace treefarm
