// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/region_model.h"

namespace treefarm {

/// Settings of a guide's model before any pass; each guide uses those that apply to it. Records are in units that suit
/// `radiance_scale` (a typical emitted radiance); the BSDF is sampled with probability `bsdf_fraction`.
struct FirstModel {
    float radiance_scale = 1.0f;
    float bsdf_fraction = 0.5f;
    bool with_views = false;     ///< the region has a T2 of one view
    float view_fraction = 0.0f;  ///< probability of sampling that view; 0: learned
    bool with_lights = false;    ///< next event learns to choose emitters
    int grid_halvings = 12;      ///< a fixed grid has 2^this regions
};

/// Size of a model, for reports. Guides without cells or views leave these at 0.
struct ModelFigures {
    std::uint64_t nodes = 0;  ///< of the spatial tree, leaves included
    std::uint64_t regions = 0;
    std::uint64_t views = 0;
    std::uint64_t cells = 0;
    int spatial_depth = 0;
    int directional_depth = 0;
};

/// Approximate bytes of a model in the form that workers sample from: per region, per view and per cell.
struct SamplerCost {
    std::uint64_t region = 0, view = 0, cell = 0;
};

/// Halvings from the cube to the smallest region.
int spatial_depth(const RegionModel& model);

}  // namespace treefarm
