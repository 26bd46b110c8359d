// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "common/guiding/box_filter.h"
#include "common/guiding/guide.h"
#include "common/guiding/settings.h"
#include "common/guiding/tree_update.h"

namespace treefarm {

/// Adds the records of finished work to a worker's sums. Threads keep a log each while they trace and commit it once
/// per unit: in the order of distributions, so that a stripe of them is locked once for many records and cells are
/// found in cache.
class Accumulator {
  public:
    /// `with_mixture`: records also feed the histograms of mixture.h.
    Accumulator(std::uint32_t pass, const Guide& guide, DirectionalFilter filter = DirectionalFilter::nearest,
                bool with_mixture = false);

    /// Adds a unit's records and the vertex counts per distribution. Thread-safe.
    void commit(std::span<const Record> records, std::span<const std::uint32_t> counts, const UpdateCaps& caps);

    /// Hands out the sums and starts again from zero. No commit may be in flight.
    TreeSums take();
    /// Gives back what was handed out, cleared: the next take() need not make it anew. Not while take() runs.
    void give_back(TreeSums cleared);

  private:
    static constexpr std::size_t kStripes = 64;

    /// Cell of each record of a block.
    using BlockCells = std::array<std::uint32_t, BoxBlock::kRecords>;

    /// Quanta for the cells of so many codes.
    struct Overlaps {
        static constexpr std::uint32_t kMost = BoxBlock::kRecords * (BoxBlock::kParts - 1);
        std::uint32_t count = 0;
        std::array<std::uint32_t, kMost> distribution, code, cell;
        std::array<std::uint64_t, kMost> quanta;
    };

    template <class DistributionOf, class CodeOf>
    void find_cells(std::uint32_t count, DistributionOf distribution, CodeOf code, std::span<std::uint32_t> cells);
    void add_block(std::span<const Record> records, UpdateCaps& met);
    void add_boxes(std::span<const Record> records, const BlockCells& cells, UpdateCaps& met);
    void add_reflected(const Record& record, UpdateCaps& met);
    void add_to_cell(std::uint32_t cell, std::uint64_t quanta, UpdateCaps& met);
    int exponent(const Record& record) const { return guide_.quantum_exponent(record.distribution); }

    SumsShape shape() const {
        return {guide_.region_count(), guide_.cell_count(), with_mixture_, guide_.view_count(), guide_.learns_lights()};
    }

    const Guide& guide_;
    const DirectionalFilter filter_;
    const bool with_mixture_;
    TreeSums sums_;
    std::optional<TreeSums> spare_;  ///< all zero
    std::mutex caps_lock_;
    std::array<std::mutex, kStripes> stripe_locks_;
};

}  // namespace treefarm
