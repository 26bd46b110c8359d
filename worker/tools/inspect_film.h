// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/flip/plane.h"
#include "worker/tools/inspect_point.h"

namespace treefarm {

/// Maps of the tree at what each pixel's centre sees. NaN where nothing is seen, or a surface that no tree guides.
struct FilmMaps {
    RgbImage regions;     ///< a colour hashed from the number of the region; black where nothing is seen
    Plane bsdf_fraction;  ///< a_BSDF
    Plane view_fraction;  ///< a_T2, 0 where there is none
    Plane cells;          ///< AnyModel::cells_by_region() there
};

/// A colour that tells numbers apart. Linear.
Rgb hashed_colour(std::uint32_t number);

FilmMaps film_maps(const TraceScene& scene, const AnyModel& tree, const AnySampler& guide);

}  // namespace treefarm
