// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Prefetch of units: how many units a worker requests. Enough that no thread waits while units are left; no more,
/// since a unit held here cannot be given to another worker. Pure bookkeeping.
class Prefetch {
  public:
    explicit Prefetch(std::size_t threads) : threads_(threads) {}

    /// Start of a pass: resets all counts.
    void begin() { *this = Prefetch(threads_); }
    /// Arrival of `units`; `nothing_left`: the coordinator has none to give for now.
    void receive(std::size_t units, bool nothing_left) {
        credit_ -= std::min(credit_, units);
        nothing_left_ = nothing_left;
        requested_at_.reset();
    }

    /// Number of units to request now, with `queued` units waiting here; no value: request nothing yet. A request for 0
    /// units only tells the coordinator how few are left here.
    std::optional<std::size_t> request(const PassPlan& plan, int tile_size, std::size_t queued) {
        const std::size_t per_thread = kUnitsPerThread + kPathsPerThread / plan.unit_paths(tile_size);
        const std::size_t depth = per_thread * threads_;
        const std::size_t more = depth - std::min(depth, queued + credit_);
        // A coordinator that still owes units, and sees how few are left here, sends some more.
        const bool hungry = !nothing_left_ && queued < threads_ && (!requested_at_ || queued < *requested_at_);
        if (!hungry && (more == 0 || (more < std::max<std::size_t>(1, threads_ / 2) && queued > 0))) return {};
        credit_ += more;
        requested_at_ = queued;
        return more;
    }

    bool nothing_left() const { return nothing_left_; }
    /// Whether requested units may arrive late: enough are queued.
    bool is_well_stocked(const PassPlan& plan, int tile_size, std::size_t queued) const {
        return !nothing_left_ && plan.has_long_units(tile_size) && queued >= 2 * threads_;
    }

  private:
    /// Queue depth of a thread: kUnitsPerThread units, plus the units of kPathsPerThread camera paths, since small
    /// units are finished before an answer arrives.
    static constexpr std::size_t kUnitsPerThread = 3, kPathsPerThread = 8192;

    std::size_t threads_;
    std::size_t credit_ = 0;                   ///< units requested that have not arrived
    std::optional<std::size_t> requested_at_;  ///< units queued at the last request, if none have arrived since
    bool nothing_left_ = false;                ///< the last answer brought no units
};

}  // namespace treefarm
