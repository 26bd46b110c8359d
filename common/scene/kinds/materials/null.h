// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// No surface: light passes straight through.
struct NullMaterial {
    Lobes lobes() const { return {.null = true}; }
    static void fields(auto&, auto&) {}
};

}  // namespace treefarm
