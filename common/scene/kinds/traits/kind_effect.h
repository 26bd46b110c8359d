// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// The effect of a kind that is an effect of its own. It must be a row in the table of effects (common/config/effects),
/// or compilation fails.
struct KindEffect {
    const char* name;   ///< "bitmaps"
    const char* title;  ///< noun for one of the kind: "bitmap"
};

}  // namespace treefarm
