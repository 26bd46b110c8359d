// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// Blend (1 - weight) * first + weight * second. Its lobes are those of its parts.
struct BlendMaterial {
    FloatInput weight{0.5f};
    std::int32_t first = kNone, second = kNone;  ///< indices in Scene::materials, smaller than this material's own

    /// Whether the sides are those of the parts: the back of a blend is the blend of their backs.
    static constexpr bool kSidesOfParts = true;
    Lobes lobes() const { return {}; }
    static void fields(auto& self, auto& visitor) {
        visitor.fraction("weight of the blend", self.weight);
        visitor.part("blended material", self.first);
        visitor.part("blended material", self.second);
    }
};

}  // namespace treefarm
