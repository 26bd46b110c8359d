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

/// The simplest guide that can be, to read first and to copy from (docs/use/write-a-guide.md): regions of a fixed grid,
/// in each the strata of directions (strata.h), sampled in proportion to the radiance that the pass before recorded
/// there, but for a part that all share alike, however dark (grids.even_part).
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
    /// Mean radiance that the region has learned of this direction; negative where it has learned nothing.
    float radiance(std::uint32_t region, std::uint32_t code) const;

    // Where records go: CellAccumulator.
    std::uint32_t cell_count() const { return strata_.cell_count(); }
    std::uint32_t cell(std::uint32_t region, std::uint32_t code) const { return StrataTable::cell(region, code); }
    std::uint32_t cell_side(std::uint32_t, std::uint32_t) const { return StrataTable::cell_side(); }
    void prefetch_pdf(std::uint32_t, std::uint32_t) const {}
    void prefetch_pdf_cell(std::uint32_t, std::uint32_t) const {}

    std::size_t bytes() const { return region_bytes() + strata_.bytes(); }

  private:
    StrataTable strata_;
};

/// The coordinator's memory: none of directions, only what all guides share.
class GridLearner {
  public:
    GridModel learn(const GridModel& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                    RefineReport& report);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(lights_, next_event_, mixture_);
    }

  private:
    LightLearner lights_;
    NextEventLearner next_event_;
    MixtureLearner mixture_;
};

/// The grid among the guides (guides.h).
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
