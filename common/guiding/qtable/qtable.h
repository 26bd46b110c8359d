// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/regions/even_guide.h"

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

/// Least weight of a stratum, as a fraction of its region's mean.
inline constexpr double kTableFloor = 0.02;

/// The table in the form that workers sample from.
class QTableSampler : public StrataSampler {
  public:
    explicit QTableSampler(const QTableModel& model);

    static constexpr bool kCountsVisits = true;

    /// Value Q; 0 for strata without visits, the initial value of the method.
    float radiance(std::uint32_t region, std::uint32_t code) const { return q_[cell(region, code)]; }

    std::size_t bytes() const { return StrataSampler::bytes() + q_.size() * sizeof(q_[0]); }

  private:
    std::vector<float> q_;
};

/// Cells of the table (EvenGuide), with the number of visits behind each Q.
class QTableCells {
  public:
    using Model = QTableModel;
    using Sampler = QTableSampler;

    static constexpr std::uint32_t kMagic = 0x54514654;  ///< "TFQT"
    static constexpr SamplerCost kCost = {16, 0, 8};

    static void begin(QTableModel& model, std::size_t cells);
    static void write(ByteWriter& out, const QTableModel& model);
    static void read(ByteReader& in, std::uint32_t regions, QTableModel& model);
    double learn(const QTableModel& model, const CellSums& sums, const RefineSettings& settings, std::uint32_t region,
                 QTableModel& next);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(visits_);
    }

  private:
    std::vector<double> visits_;  ///< per cell, those of earlier passes at less weight; empty: none
};

using QTableGuide = EvenGuide<QTableCells>;

}  // namespace treefarm
