#pragma once

#include <array>
#include <mutex>
#include <span>
#include <vector>

#include "common/guiding/guide.h"
#include "common/guiding/tree_update.h"

namespace treefarm {

/// Adds the records of finished work to a worker's sums. Threads keep a log each while they trace and commit it once
/// per unit: sorted by region, so that a stripe of regions is locked once for many records and cells are found in
/// cache.
class Accumulator {
  public:
    Accumulator(std::uint32_t pass, const Guide& guide);

    /// Adds a unit's records and the vertex counts per region. Thread-safe.
    void commit(std::span<const Record> records, std::span<const std::uint32_t> counts, const UpdateCaps& caps);

    /// Hands out the sums and starts again from zero. No commit may be in flight.
    TreeSums take();

  private:
    static constexpr std::size_t kStripes = 64;

    const Guide& guide_;
    TreeSums sums_;
    std::mutex caps_lock_;
    std::array<std::mutex, kStripes> stripe_locks_;
};

}  // namespace treefarm
