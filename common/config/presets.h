// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/config/setting.h"

namespace treefarm {

/// The settings that a value of guiding.preset stands for; "" stands for none.
std::span<const Setting> preset_settings(const std::string& preset);

}  // namespace treefarm
