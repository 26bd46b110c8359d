// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/shapes/shape_traits.h"

namespace treefarm {

/// All shapes of a group, placed by an invertible transform.
struct Instance {
    std::int32_t group = kNone;
    Imath::M44f to_world;  ///< for row vectors: p' = p * to_world

    Box3 box() const { return {}; }  ///< none of its own
    static void fields(auto& self, auto& visitor) {
        visitor.group(self.group);
        visitor.transform(self.to_world);
    }
};

}  // namespace treefarm
