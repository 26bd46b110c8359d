// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/regions/first_model.h"
#include "common/guiding/regions/light_probabilities.h"
#include "common/guiding/regions/mixture.h"
#include "common/guiding/regions/next_event.h"
#include "common/guiding/regions/region_sampler.h"
#include "common/guiding/regions/strata.h"

namespace treefarm {

/// Q-learning of light (Dahm and Keller 2017, "Learning light transport the reinforced way"): a table Q(region,
/// stratum) of radiances over the regions of a fixed grid and strata of directions (strata.h). A visit adds the
/// emission met in its direction plus the table's estimate at the next vertex (guiding.bootstrap, 1 here: Cavus 2020,
/// eq. 2.27, with one sample of the integral). Q is the mean of the visits; the weight of earlier passes halves with
/// each pass. A stratum's probability is proportional to Q, but at least a floor (grids.table_floor), since a stratum
/// that is never sampled is never learned.
struct QTableModel : RegionModel {
    std::vector<float> q;  ///< per region kStrata radiances, mean of the channels, >= 0 and finite
    bool operator==(const QTableModel&) const = default;
};

/// The table in the form that workers sample from.
class QTableSampler : public RegionSampler {
  public:
    explicit QTableSampler(const QTableModel& model);

    static constexpr bool kCountsVisits = true;

    StrataTable::Sample sample(std::uint32_t region, const Draw& random) const {
        return strata_.sample(region, random);
    }
    float pdf(std::uint32_t region, std::uint32_t code) const { return strata_.pdf(region, code); }
    /// Value Q; 0 for strata without visits, the initial value of the method.
    float radiance(std::uint32_t region, std::uint32_t code) const { return q_[StrataTable::cell(region, code)]; }

    // Cells of records, for CellAccumulator.
    std::uint32_t cell_count() const { return strata_.cell_count(); }
    std::uint32_t cell(std::uint32_t region, std::uint32_t code) const { return StrataTable::cell(region, code); }
    std::uint32_t cell_side(std::uint32_t, std::uint32_t) const { return StrataTable::cell_side(); }
    void prefetch_pdf(std::uint32_t, std::uint32_t) const {}
    void prefetch_pdf_cell(std::uint32_t, std::uint32_t) const {}

    std::size_t bytes() const { return region_bytes() + strata_.bytes() + q_.size() * sizeof(q_[0]); }

  private:
    StrataTable strata_;
    std::vector<float> q_;
};

/// Learner of the table: number of visits behind each Q.
class QTableLearner {
  public:
    QTableModel learn(const QTableModel& model, const CellSums& sums, const RefineSettings& settings,
                      bool learn_mixture, RefineReport& report);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(visits_, lights_, next_event_, mixture_);
    }

  private:
    std::vector<double> visits_;  ///< per cell, those of earlier passes at less weight; empty: none
    LightLearner lights_;
    NextEventLearner next_event_;
    MixtureLearner mixture_;
};

/// The table as a Guide (guides.h).
struct QTableGuide {
    using Model = QTableModel;
    using Sampler = QTableSampler;
    using Learner = QTableLearner;

    static constexpr std::uint32_t kMagic = 0x54514654;  ///< "TFQT"
    static constexpr bool kGrows = false;
    static constexpr int kKernels = 3;
    static constexpr bool kPlainKernels = false;
    static constexpr SamplerCost kCost = {16, 0, 8};

    static QTableModel first(const Box3& bounds, const FirstModel& settings);
    static Bytes encode(const QTableModel& model);
    static QTableModel decode(std::span<const std::uint8_t> bytes);
    static ModelFigures figures(const QTableModel& model) { return even_figures(model); }
};

}  // namespace treefarm
