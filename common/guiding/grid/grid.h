// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/guiding/regions/even_guide.h"

namespace treefarm {

/// The simplest guide, to be read first and copied (docs/use/write-a-guide.md): regions of a fixed grid, each with
/// fixed strata of directions (strata.h). A stratum's probability is proportional to the radiance that the previous
/// pass recorded there, plus an equal part for all (grids.even_part), so that dark strata are sampled, too.
struct GridModel : RegionModel {
    std::vector<std::uint32_t> mass;  ///< per region kStrata probabilities in Z-order, times 2^kMassBits, their sum
    bool operator==(const GridModel&) const = default;
};

/// The grid in the form that workers sample from.
class GridSampler : public StrataSampler {
  public:
    explicit GridSampler(const GridModel& model) : StrataSampler(model, model.mass) {}

    /// Mean radiance learned for this direction in the region; negative if nothing was learned.
    float radiance(std::uint32_t region, std::uint32_t code) const;
};

/// Cells of the grid (EvenGuide), without memory of earlier passes.
struct GridCells {
    using Model = GridModel;
    using Sampler = GridSampler;

    static constexpr std::uint32_t kMagic = 0x52474654;  ///< "TFGR"
    static constexpr SamplerCost kCost = {16, 0, 4};

    static void begin(GridModel& model, std::size_t cells);
    static void write(ByteWriter& out, const GridModel& model);
    static void read(ByteReader& in, std::uint32_t regions, GridModel& model);
    static double learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings,
                        std::uint32_t region, GridModel& next);

    template <class Archive>
    void serialize(Archive&) {}
};

using GridGuide = EvenGuide<GridCells>;

}  // namespace treefarm
