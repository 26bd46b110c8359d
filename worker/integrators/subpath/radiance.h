// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/radiance_limit.h"
#include "common/math/vec.h"

namespace treefarm {

/// Whether a film accepts a colour as radiance: 0 to kMostRadiance.
inline bool is_radiance(const Rgb& c) {
    const auto is_possible = [](float v) { return v >= 0.0f && v <= kMostRadiance; };
    return is_possible(c.x) && is_possible(c.y) && is_possible(c.z);
}

}  // namespace treefarm
