// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "common/plan/schedule.h"

namespace treefarm {

/// How much work a worker asks for: so much that no thread waits while more is under way, and no more, since what it
/// has others cannot get. Pure bookkeeping.
class Prefetch {
  public:
    explicit Prefetch(std::size_t threads) : threads_(threads) {}

    /// A pass begins.
    void begin() { *this = Prefetch(threads_); }
    /// Units have come, or none, since for now nothing is left.
    void receive(std::size_t units, bool nothing_left) {
        credit_ -= std::min(credit_, units);
        nothing_left_ = nothing_left;
        requested_at_.reset();
    }

    /// Units to ask for now, where so many are queued; nothing: better not to ask. None: to say how little is left.
    std::optional<std::size_t> request(const PassPlan& plan, int tile_size, std::size_t queued) {
        const std::size_t per_thread = kUnitsPerThread + kPathsPerThread / plan.unit_paths(tile_size);
        const std::size_t depth = per_thread * threads_;
        const std::size_t more = depth - std::min(depth, queued + credit_);
        // A coordinator that owes much of it, and sees how little is left here, gives some more.
        const bool hungry = !nothing_left_ && queued < threads_ && (!requested_at_ || queued < *requested_at_);
        if (!hungry && (more == 0 || (more < std::max<std::size_t>(1, threads_ / 2) && queued > 0))) return {};
        credit_ += more;
        requested_at_ = queued;
        return more;
    }

    bool nothing_left() const { return nothing_left_; }
    /// Whether what is asked for need not come soon.
    bool is_well_stocked(const PassPlan& plan, int tile_size, std::size_t queued) const {
        return !nothing_left_ && plan.has_long_units(tile_size) && queued >= 2 * threads_;
    }

  private:
    /// Units to have for each thread, and so many camera paths beside: small units are done before an answer comes.
    static constexpr std::size_t kUnitsPerThread = 3, kPathsPerThread = 8192;

    std::size_t threads_;
    std::size_t credit_ = 0;  ///< units asked for that have not come
    std::optional<std::size_t>
        requested_at_;           ///< units that were queued when more were asked for, and none have come since
    bool nothing_left_ = false;  ///< the last work that came was none
};

}  // namespace treefarm
