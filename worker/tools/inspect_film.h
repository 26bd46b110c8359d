// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/plane.h"
#include "worker/tools/inspect_point.h"

namespace treefarm {

/// Maps of the tree at the hit of each pixel's centre. NaN if nothing is hit, or the surface is not guided.
struct FilmMaps {
    RgbImage regions;     ///< a colour hashed from the region's number; black if nothing is hit
    Plane bsdf_fraction;  ///< a_BSDF
    Plane view_fraction;  ///< a_T2, 0 without a view
    Plane cells;          ///< AnyModel::cells_by_region() of the region
};

/// Linear colour that distinguishes numbers.
Rgb hashed_colour(std::uint32_t number);

FilmMaps film_maps(const TraceScene& scene, const AnyModel& tree, const AnySampler& guide);

}  // namespace treefarm
