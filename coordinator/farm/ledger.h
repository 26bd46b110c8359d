// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/film/done_work.h"
#include "common/film/work_unit.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Verdict on a worker's result.
enum class Verdict : std::uint8_t {
    accepted,        ///< the worker has all of these units, and each is unfinished
    late,            ///< it had them, but another worker's copy of some was faster
    protocol_error,  ///< a protocol error: some it never had, or one is named twice
};

/// A poison unit: workers were lost while they had it.
struct PoisonUnit {
    WorkUnit unit;
    std::uint32_t deaths = 0;

    bool operator==(const PoisonUnit&) const = default;
};

/// Limits of the units that a worker gets at once.
struct Portion {
    std::size_t units = 0;    ///< largest number of units
    std::uint64_t paths = 0;  ///< largest number of paths, unless one unit has more
    std::uint64_t piece = 0;  ///< largest number of paths of a unit, if it can be cut
};

/// Work of one pass: waiting units, issued units with their workers, and finished units. Every film atom is accepted
/// exactly once, though several workers may have it: the first result counts. Pure bookkeeping: no clock, no messages.
class Ledger {
  public:
    /// Worker losses over one unit after which the render fails.
    static constexpr std::size_t kMostDeaths = 3;

    /// All units of a pass, in tiles of `tile_size` pixels, except those in `done`. `poison_units`: those from
    /// before a resume, which are not in `done` and are issued uncut.
    Ledger(const PassPlan& plan, int width, int height, int tile_size, const DoneWork& done = {},
           std::span<const PoisonUnit> poison_units = {});

    /// Issues a portion to a worker. A unit with more paths than portion.piece is cut in halves, but into no piece that
    /// takes less time than its request. A unit over which a worker was lost is issued alone: to a worker without
    /// units, which gets no other until it is done. `overdue`: the worker is idle though it has units, as with a thread
    /// that is stuck; it may then get one as well.
    std::vector<WorkUnit> issue(int worker, Portion portion, bool overdue = false);

    /// Whether the worker has a unit that was issued alone.
    bool has_suspect(int worker) const;

    /// Issues copies to an idle worker, once no unit waits, of the units of workers with most paths to go, those first
    /// that they will begin last. `gain(other, unit)`: expected saving in seconds of a copy of what `other` has; none
    /// is issued unless it is above 0 for each worker that has the unit or a copy. `overdue`: as in issue().
    std::vector<WorkUnit> issue_copies(int worker, std::size_t count,
                                       const std::function<double(int, const WorkUnit&)>& gain, bool overdue = false);
    /// Whether a worker was lost while it had this unit.
    bool is_suspect(const WorkUnit& unit) const { return deaths_.contains(unit); }

    /// Verdict on a result with these units, without accepting it.
    Verdict judge(int worker, std::span<const WorkUnit> units) const;

    /// Marks the units as finished if the verdict is `accepted`; otherwise nothing changes. Returns the verdict.
    Verdict accept(int worker, std::span<const WorkUnit> units);
    /// Drops a late result: units that no worker has now are issued again first.
    void drop(int worker, std::span<const WorkUnit> units);

    /// Units of a worker that others have finished, so that it need not begin them. Each is returned once.
    std::vector<WorkUnit> take_superseded(int worker);

    /// Takes back a worker's units, to be issued again first; `lost`: one of them may be the cause of its loss. Returns
    /// the number of units.
    std::size_t reclaim(int worker, bool lost = false);
    /// Clears the worker's losses, since it is back: no unit caused one.
    void forgive(int worker);
    /// The unit over which most workers were lost, and their number; 0: none.
    std::pair<WorkUnit, std::size_t> worst_poison_unit() const;
    /// All poison units, for a checkpoint. One that is about to end the render does so after a resume at the next loss.
    std::vector<PoisonUnit> poison_units() const;

    bool complete() const { return done_ == total_; }
    std::size_t waiting() const { return waiting_.size(); }
    /// Number of waiting units that are issued alone.
    std::size_t suspects() const { return suspects_.size(); }
    /// Paths of all waiting units that are not issued alone.
    std::uint64_t waiting_paths() const { return waiting_paths_; }
    std::size_t outstanding() const { return holders_.size(); }
    std::size_t outstanding(int worker) const;
    /// Paths of a worker's units.
    std::uint64_t outstanding_paths(int worker) const;
    /// Number of copies that were issued, and of late results.
    std::uint64_t copies() const { return copies_; }
    /// Paths of a unit; a chain counts as one.
    std::uint64_t paths(const WorkUnit& unit) const;
    /// Sum of the units' weights: of all, and of the finished ones.
    std::uint64_t total() const { return total_; }
    std::uint64_t done() const { return done_; }

  private:
    /// Workers that have a unit or a copy of it.
    struct Holders {
        std::vector<int> workers;
        std::uint64_t issued = 0;  ///< sequence number of the first issue
        bool has(int worker) const { return std::find(workers.begin(), workers.end(), worker) != workers.end(); }
    };

    bool cut_front(std::uint64_t paths);
    std::uint64_t least_weight(UnitKind kind) const;  ///< of a piece
    void hold(const WorkUnit& unit, int worker);
    void put_back(const WorkUnit& unit);
    bool release(std::map<WorkUnit, Holders>::iterator held, int worker);
    void burden(int worker, const WorkUnit& unit);
    void lighten(int worker, const WorkUnit& unit);

    const std::uint32_t unit_spp_;  ///< samples of a pixel in a tile
    std::deque<WorkUnit> waiting_;
    std::deque<WorkUnit> suspects_;             ///< each to be issued alone
    std::map<WorkUnit, Holders> holders_;       ///< issued units
    std::map<WorkUnit, std::set<int>> deaths_;  ///< workers that had a unit when they were lost
    std::set<std::pair<int, WorkUnit>> superseded_, told_;
    /// Units and paths of a worker.
    struct Load {
        std::size_t units = 0;
        std::uint64_t paths = 0;
    };
    std::map<int, Load> loads_;
    std::uint64_t waiting_paths_ = 0, issued_ = 0, copies_ = 0;
    std::uint64_t total_ = 0;
    std::uint64_t done_ = 0;
};

}  // namespace treefarm
