// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Into which region of the tree a record goes.
enum class SpatialFilter : std::uint8_t {
    nearest,     ///< that of its position
    stochastic,  ///< that of its position moved by up to half the region's size
};

/// How a record spreads over a region's directional cells.
enum class DirectionalFilter : std::uint8_t {
    nearest,  ///< all of it into the cell of its direction
    box,      ///< over a square of that cell's size around its direction
};

/// The quantity in proportion to which a region's cells are sampled.
enum class GuidingTarget : std::uint8_t {
    radiance,  ///< their mean radiance: sums of L / p
    variance,  ///< the square root of their second moment, from sums of L^2 / p (Rath et al. 2020)
};

/// What view-dependent vertices teach.
enum class ViewRecords : std::uint8_t {
    radiance,  ///< their view the radiance that arrives, their region nothing: as published
    product,   ///< their view what it reflects of that, their region the radiance
};

}  // namespace treefarm
