// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Advice for a file with this extension (".blend") that is given instead of a scene; for unknown extensions, the
/// formats of scenes.
std::string foreign_format_cure(const std::string& extension);

}  // namespace treefarm
