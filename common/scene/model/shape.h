// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/error.h"
#include "common/scene/kinds/shapes.h"

namespace treefarm {

/// A surface that rays can hit. Its index in Scene::shapes is its id everywhere (id of the geometry, table of
/// emitters).
struct Shape {
    ShapeKind geometry;
    std::int32_t material = kNone;  ///< kNone for instances only: the shapes of their group have their own
    std::int32_t emitter = kNone;   ///< index of an area emitter on the front side, or kNone; never in a group
    std::int32_t group = kNone;     ///< index of its group, below Scene::group_count; kNone: it is in the world
    std::string name;
    Location where;
};

/// Box of a shape's own surface, in its group's space; empty for instances.
inline Box3 own_box(const Shape& shape) {
    return std::visit([](const auto& kind) { return kind.box(); }, shape.geometry);
}

}  // namespace treefarm
