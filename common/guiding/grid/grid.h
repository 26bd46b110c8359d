// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/guiding/regions/first_model.h"
#include "common/guiding/regions/light_probabilities.h"
#include "common/guiding/regions/mixture.h"
#include "common/guiding/regions/next_event.h"
#include "common/guiding/regions/region_sampler.h"
#include "common/guiding/regions/strata.h"

namespace treefarm {

/// The simplest guide, to be read first and copied (docs/use/write-a-guide.md): regions of a fixed grid, each with
/// fixed strata of directions (strata.h). A stratum's probability is proportional to the radiance that the previous
/// pass recorded there, plus an equal part for all (grids.even_part), so that dark strata are sampled, too.
struct GridModel : RegionModel {
    std::vector<std::uint32_t> mass;  ///< per region kStrata probabilities in Z-order, times 2^kMassBits, their sum
    bool operator==(const GridModel&) const = default;
};

/// The grid in the form that workers sample from.
class GridSampler : public RegionSampler {
  public:
    explicit GridSampler(const GridModel& model);

    StrataTable::Sample sample(std::uint32_t region, const Draw& random) const {
        return strata_.sample(region, random);
    }
    float pdf(std::uint32_t region, std::uint32_t code) const { return strata_.pdf(region, code); }
    /// Mean radiance learned for this direction in the region; negative if nothing was learned.
    float radiance(std::uint32_t region, std::uint32_t code) const;

    // Cells of records, for CellAccumulator.
    std::uint32_t cell_count() const { return strata_.cell_count(); }
    std::uint32_t cell(std::uint32_t region, std::uint32_t code) const { return StrataTable::cell(region, code); }
    std::uint32_t cell_side(std::uint32_t, std::uint32_t) const { return StrataTable::cell_side(); }
    void prefetch_pdf(std::uint32_t, std::uint32_t) const {}
    void prefetch_pdf_cell(std::uint32_t, std::uint32_t) const {}

    std::size_t bytes() const { return region_bytes() + strata_.bytes(); }

  private:
    StrataTable strata_;
};

/// Learner of the grid. It remembers nothing about directions, only the shared parts of all guides.
class GridLearner {
  public:
    GridModel learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                    RefineReport& report);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(lights_, next_event_, mixture_);
    }

  private:
    LightLearner lights_;
    NextEventLearner next_event_;
    MixtureLearner mixture_;
};

/// The grid as a Guide (guides.h).
struct GridGuide {
    using Model = GridModel;
    using Sampler = GridSampler;
    using Learner = GridLearner;

    static constexpr std::uint32_t kMagic = 0x52474654;  ///< "TFGR"
    static constexpr bool kGrows = false;
    static constexpr int kKernels = 3;
    static constexpr bool kPlainKernels = false;
    static constexpr SamplerCost kCost = {16, 0, 4};

    static GridModel first(const Box3& bounds, const FirstModel& settings);
    static Bytes encode(const GridModel& model);
    static GridModel decode(std::span<const std::uint8_t> bytes);
    static ModelFigures figures(const GridModel& model) { return even_figures(model); }
};

}  // namespace treefarm
