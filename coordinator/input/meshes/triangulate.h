// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// Cuts a nearly flat polygon into triangles of the same orientation, given as indices of its corners: convex ones into
/// a fan around the first corner, concave ones by ear clipping (Meisters 1975). False for concave polygons of more than
/// 256 corners, for which that would take too long.
bool triangulate(std::span<const Vec3> polygon, std::vector<std::array<std::size_t, 3>>& triangles);

}  // namespace treefarm
