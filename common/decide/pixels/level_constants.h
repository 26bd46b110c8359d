// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/policy.h"

namespace treefarm::policy {

/// Light level around a pixel, in relation to which noise is measured.
inline constexpr Constant kLevels[] = {
    {"levels.least", 0.1, "darker blocks count as bright as this share of the image's mean", kDecisions},
};

}  // namespace treefarm::policy
