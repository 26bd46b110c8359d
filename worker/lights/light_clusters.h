// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/guiding/regions/region_model.h"
#include "worker/lights/discrete_table.h"

namespace treefarm {

/// Emitters in up to kLightClusters clusters: runs of the table by which they are chosen by power. A region's
/// LightProbabilities say how often next event takes each cluster; within one, emitters are chosen by power as ever.
/// Everything is whole multiples of 2^-32, so that what pick() does and what factor() says agree.
class LightClusters {
  public:
    LightClusters() = default;

    /// Clusters of a table's entries. If there are more entries with weight than clusters, neighbours of about the
    /// same weight together share one.
    explicit LightClusters(const DiscreteTable& table) : cluster_of_entry_(table.size()) {
        std::uint32_t left = 0;
        for (std::uint32_t i = 0; i < table.size(); ++i)
            left += table.begin(i + 1) > table.begin(i);
        std::uint64_t begin = 0;
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            if (table.begin(i + 1) == table.begin(i)) continue;  // never chosen: of no cluster
            cluster_of_entry_[i] = static_cast<std::uint8_t>(count_);
            --left;
            // A cluster ends where it has its part of what is left, or where those to come have to get one each.
            const auto clusters_left = static_cast<std::uint32_t>(kLightClusters - count_);
            const std::uint64_t part = (kWhole - begin) / clusters_left;
            if (left != 0 && left > clusters_left - 1 && (table.begin(i + 1) - begin < part || clusters_left == 1))
                continue;
            const auto cluster = static_cast<std::size_t>(count_++);
            width_[cluster] = table.begin(i + 1) - begin;
            per_width_[cluster] = 1.0 / static_cast<double>(width_[cluster]);
            begin = table.begin(i + 1);
        }
    }

    int count() const { return count_; }
    /// Cluster of an entry that can be chosen.
    std::uint8_t of_entry(std::uint32_t entry) const { return cluster_of_entry_[entry]; }

    /// A cluster that was chosen, and the bits by which to choose an emitter in it.
    struct Choice {
        std::uint8_t cluster;
        std::uint32_t bits;
        float probability;
        float factor;  ///< probability over that by power
    };

    /// Chooses a cluster by 32 random bits. There must be one.
    Choice pick(const LightProbabilities& probabilities, std::uint32_t bits) const {
        // All that lie before, without a branch that nothing predicts.
        std::uint64_t end = 0, begin = 0, begin_by_power = 0;
        int c = 0;
        for (int i = 0; i + 1 < count_; ++i) {
            end += width(probabilities, i);
            const bool before = end <= bits;
            begin = before ? end : begin;
            begin_by_power += before ? width_[static_cast<std::size_t>(i)] : 0;
            c += before;
        }
        const std::uint64_t w = std::max<std::uint64_t>(width(probabilities, c), 1);
        const std::uint64_t by_power = width_[static_cast<std::size_t>(c)];
        // What rounding leaves over at the end belongs to the last cluster.
        const std::uint64_t within = std::min<std::uint64_t>(bits - begin, w - 1);
        const auto probability = static_cast<float>(w) * 0x1p-32f;
        return {static_cast<std::uint8_t>(c), static_cast<std::uint32_t>(begin_by_power + scaled(within, by_power, w)),
                probability, static_cast<float>(static_cast<double>(w) * per_width_[static_cast<std::size_t>(c)])};
    }

    /// Probability of an entry of the table, over that by power. `share`: nullptr, by power.
    float factor(const LightProbabilities* probabilities, std::uint32_t entry) const {
        if (!probabilities || count_ == 0) return 1.0f;
        const std::uint8_t cluster = cluster_of_entry_[entry];
        return static_cast<float>(static_cast<double>(width(*probabilities, cluster)) * per_width_[cluster]);
    }

  private:
    static constexpr std::uint64_t kWhole = std::uint64_t{1} << 32;

    /// Probability of a cluster, out of 2^32.
    std::uint64_t width(const LightProbabilities& probabilities, int cluster) const {
        return ((probabilities[0] * width_[static_cast<std::size_t>(cluster)]) >> 15) +
               (std::uint64_t{probabilities[static_cast<std::size_t>(cluster) + 1]} << 17);
    }

    /// value * to / from, below `to`; all below 2^33.
    static std::uint64_t scaled(std::uint64_t value, std::uint64_t to, std::uint64_t from) {
        return to == from ? value
                          : static_cast<std::uint64_t>(static_cast<double>(value) * static_cast<double>(to) /
                                                       static_cast<double>(from));
    }

    int count_ = 0;
    std::array<std::uint64_t, kLightClusters> width_{};  ///< by power, of 2^32
    /// Its reciprocal, in double: so a choice by power has the factor 1.
    std::array<double, kLightClusters> per_width_{};
    std::vector<std::uint8_t> cluster_of_entry_;
};

}  // namespace treefarm
