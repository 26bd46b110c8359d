// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"

namespace treefarm {

/// Whether a film accepts a colour as radiance: finite and not negative.
inline bool is_radiance(const Rgb& c) {
    return is_finite(c) && c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f;
}

}  // namespace treefarm
