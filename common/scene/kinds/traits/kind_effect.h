// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// The effect that a kind is, where it is one of its own: a row in the table of effects (common/plan/effects), which
/// does not compile without.
struct KindEffect {
    const char* name;   ///< "bitmaps"
    const char* title;  ///< one of the kind: "bitmap"
};

}  // namespace treefarm
