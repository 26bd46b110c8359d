// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"
#include "common/scene/kinds/shapes.h"

namespace treefarm {

/// Something that rays can hit. Its place in Scene::shapes is its id everywhere (the geometry's id, the emitter table).
struct Shape {
    ShapeKind geometry;
    std::int32_t material = kNone;  ///< kNone for instances only: their group's shapes have their own
    std::int32_t emitter = kNone;   ///< index of an area emitter on the front side, or kNone; never in a group
    std::int32_t group = kNone;  ///< the group it belongs to, below Scene::group_count; kNone: it stands in the world
    std::string name;
    Location where;
};

/// Box of a shape's own surface, in its group's space; empty for instances.
inline Box3 own_box(const Shape& shape) {
    return std::visit([](const auto& kind) { return kind.box(); }, shape.geometry);
}

}  // namespace treefarm
