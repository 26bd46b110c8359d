// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// A conductor's complex index of refraction eta + i k, in linear Rec. 709.
struct Metal {
    const char* name;
    Rgb eta, k;
};

/// The metal (or semiconductor) of this name in Mitsuba, such as "Cu" or "Au"; empty if there is none.
std::optional<Metal> find_metal(const std::string& name);

std::vector<std::string> metal_names();

}  // namespace treefarm
