// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coordinator/input/meshes/ply_header.h"

namespace treefarm::ply {

/// Properties that form a mesh attribute: one (a number) or three (a colour).
struct AttributeGroup {
    std::string name;                     ///< as in MeshAttribute
    std::vector<std::size_t> properties;  ///< 1 or 3 indices of the element's properties
};

/// Attributes of an element. As in Mitsuba 3's documentation, red, green and blue (or r, g and b) are "color", and
/// consecutive properties with the suffixes _x _y _z, _r _g _b, _0 _1 _2 or _1 _2 _3 have the name before the suffix.
/// Mitsuba 3's program appends "_color" to the name of those in _r _g _b, so these get both names.
std::vector<AttributeGroup> attribute_groups(const Element& element);

}  // namespace treefarm::ply
