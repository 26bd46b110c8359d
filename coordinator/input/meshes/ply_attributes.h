// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/input/meshes/ply_header.h"

namespace treefarm::ply {

/// Properties that together are an attribute of a mesh: one (a number) or three (a colour).
struct AttributeGroup {
    std::string name;                     ///< as of MeshAttribute
    std::vector<std::size_t> properties;  ///< 1 or 3 of the element's, by their place
};

/// The attributes of an element. As Mitsuba 3 documents them: red, green and blue, or r, g and b, are "color";
/// properties one after another that end in _x _y _z, _r _g _b, _0 _1 _2 or _1 _2 _3 bear the name before that. Its
/// program appends
/// "_color" to the name of those in _r _g _b: they have both names here.
std::vector<AttributeGroup> attribute_groups(const Element& element);

}  // namespace treefarm::ply
