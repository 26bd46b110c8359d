// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/region_model.h"

namespace treefarm {

/// What a guide's model is before any pass; each guide takes of it what it has. Records are in units that suit
/// `radiance_scale` (a typical emitted radiance), the BSDF is sampled with the probability `bsdf_fraction`.
struct FirstModel {
    float radiance_scale = 1.0f;
    float bsdf_fraction = 0.5f;
    bool with_views = false;     ///< and a T2 of one view,
    float view_fraction = 0.0f;  ///< sampled with this probability; 0: it is learned
    bool with_lights = false;    ///< next event learns how to choose emitters
    int grid_halvings = 12;      ///< a fixed grid has 2^this regions
};

/// Size of a model, for reports. A guide without cells or views has none.
struct ModelFigures {
    std::uint64_t nodes = 0;  ///< of the spatial tree, leaves included
    std::uint64_t regions = 0;
    std::uint64_t views = 0;
    std::uint64_t cells = 0;
    int spatial_depth = 0;
    int directional_depth = 0;
};

/// Bytes of a model in the form that workers sample from, about: per region, per view and per cell.
struct SamplerCost {
    std::uint64_t region = 0, view = 0, cell = 0;
};

/// Halvings of the cube to the smallest region.
int spatial_depth(const RegionModel& model);

}  // namespace treefarm
