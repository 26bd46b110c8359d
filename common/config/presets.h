// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/config/setting.h"

namespace treefarm {

/// Settings of a value of guiding.preset; none for "".
std::span<const Setting> preset_settings(const std::string& preset);

}  // namespace treefarm
