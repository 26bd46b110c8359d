// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "common/film/work_unit.h"
#include "common/plan/schedule.h"

namespace treefarm {

/// The work of one pass: what is still to be issued, who has what, and what is done. Every atom of the film is accepted
/// exactly once. Pure bookkeeping: no clock, no messages.
class Ledger {
  public:
    /// The units of a pass, tiles of `tile_size` pixels.
    Ledger(const PassPlan& plan, int width, int height, int tile_size);

    /// Takes up to `count` units for a worker. While fewer than `shrink_below` units are left, each is issued in pieces
    /// (halve): towards the end of a pass smaller ones leave fewer workers waiting for the last one. No piece is so
    /// small that to ask for it takes longer than to trace it.
    std::vector<WorkUnit> issue(int worker, std::size_t count, std::size_t shrink_below);

    /// True if the worker has all of these units, each named once.
    bool holds(int worker, std::span<const WorkUnit> units) const;

    /// If the worker holds all of these units they are done, and true is returned; otherwise nothing changes.
    bool accept(int worker, std::span<const WorkUnit> units);

    /// Takes back what a worker has, to be issued again first. Returns the number of units.
    std::size_t reclaim(int worker);

    bool complete() const { return done_ == total_; }
    std::size_t waiting() const { return waiting_.size(); }
    std::size_t outstanding() const { return holder_.size(); }
    std::size_t outstanding(int worker) const;
    /// Sum of the units' weights: of all, and of those done.
    std::uint64_t total() const { return total_; }
    std::uint64_t done() const { return done_; }

  private:
    void halve_front();
    std::uint64_t least_weight(UnitKind kind) const;  ///< of a piece

    const std::uint32_t unit_spp_;  ///< samples of a pixel in a tile
    std::deque<WorkUnit> waiting_;
    std::map<WorkUnit, int> holder_;  ///< units that were issued, with the worker that has them
    std::uint64_t total_ = 0;
    std::uint64_t done_ = 0;
};

}  // namespace treefarm
