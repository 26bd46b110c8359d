// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Advice on a file of this extension (".blend") in place of a scene; what a scene is, where it is unknown.
std::string foreign_format_cure(const std::string& extension);

}  // namespace treefarm
