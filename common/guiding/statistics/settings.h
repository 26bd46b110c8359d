// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm {

/// Region that a record is added to.
enum class SpatialFilter : std::uint8_t {
    nearest,     ///< the region of its position
    stochastic,  ///< the region of its position moved by up to half the region's size
};

/// Distribution of a record over a region's directional cells.
enum class DirectionalFilter : std::uint8_t {
    nearest,  ///< the whole record goes to the cell of its direction
    box,      ///< the record spreads over a square of that cell's size around its direction
};

/// Quantity in proportion to which a region's cells are sampled.
enum class GuidingTarget : std::uint8_t {
    radiance,  ///< mean radiance, from sums of L / p
    variance,  ///< square root of the second moment, from sums of L^2 / p (Rath et al. 2020)
};

/// Records of view-dependent vertices.
enum class ViewRecords : std::uint8_t {
    radiance,  ///< incident radiance for the view, nothing for the region: as published
    product,   ///< reflected radiance for the view, incident radiance for the region
};

}  // namespace treefarm
