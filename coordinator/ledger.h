// SPDX-License-Identifier: Apache-2.0
#pragma once

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
#include "common/plan/schedule.h"

namespace treefarm {

/// What becomes of a worker's result.
enum class Verdict : std::uint8_t {
    accepted,        ///< the worker has all of these units, and each is still to be done
    late,            ///< it had them, but of some another worker's copy was quicker
    protocol_error,  ///< of some it never had, or names one twice
};

/// A unit over which workers were lost.
struct PoisonUnit {
    WorkUnit unit;
    std::uint32_t deaths = 0;

    bool operator==(const PoisonUnit&) const = default;
};

/// How much of a pass a worker gets at once.
struct Portion {
    std::size_t units = 0;    ///< at most
    std::uint64_t paths = 0;  ///< at most, but for one unit
    std::uint64_t piece = 0;  ///< paths of a unit at most, but for what is not cut
};

/// The work of one pass: what is still to be issued, who has what, and what is done. Every atom of the film is accepted
/// exactly once, though several workers may have it: the first result counts. Pure bookkeeping: no clock, no messages.
class Ledger {
  public:
    /// Workers that may lose their lives over a unit before it is given up.
    static constexpr std::size_t kMostDeaths = 3;

    /// The units of a pass, tiles of `tile_size` pixels, but for what is `done` and, of an earlier life of the render,
    /// those that are `deadly`: none of these is done, and each is issued as it is.
    Ledger(const PassPlan& plan, int width, int height, int tile_size, const DoneWork& done = {},
           std::span<const PoisonUnit> poison_units = {});

    /// Takes a portion for a worker. A unit of more paths than a piece may have is issued in pieces (halve), but in
    /// none so small that to ask for it takes longer than to trace it. A unit over which a worker was lost is issued
    /// alone: to a worker that has nothing, and gets nothing until it is done.
    std::vector<WorkUnit> issue(int worker, Portion portion);

    /// Whether what the worker has was issued alone.
    bool has_suspect(int worker) const;

    /// Takes second copies for a worker that has nothing, where nothing waits: units that nobody else has a copy of, of
    /// the worker with the longest way to go, those first that it will begin last. `gain(other, paths)`: seconds that
    /// such a copy is expected to save; none is issued unless above 0.
    std::vector<WorkUnit> issue_copies(int worker, std::size_t count,
                                       const std::function<double(int, std::uint64_t)>& gain);

    /// What a result with these units would be.
    Verdict judge(int worker, std::span<const WorkUnit> units) const;

    /// The units are done, if the verdict on them is `accepted`; otherwise nothing changes. Returns the verdict.
    Verdict accept(int worker, std::span<const WorkUnit> units);
    /// Drops a late result: what nobody has now is issued again first.
    void drop(int worker, std::span<const WorkUnit> units);

    /// Units that a worker has though others have done them: not worth beginning. Each is told once.
    std::vector<WorkUnit> take_superseded(int worker);

    /// Takes back what a worker has, to be issued again first; `lost`: it may be that one of these units did it.
    /// Returns the number of units.
    std::size_t reclaim(int worker, bool lost = false);
    /// The worker is back: no unit was its death.
    void forgive(int worker);
    /// The unit over which most workers were lost, and how many; none: 0.
    std::pair<WorkUnit, std::size_t> worst_poison_unit() const;
    /// All units over which workers were lost, for a checkpoint. One that would end the render does so in its next life
    /// at the next death.
    std::vector<PoisonUnit> poison_units() const;

    bool complete() const { return done_ == total_; }
    std::size_t waiting() const { return waiting_.size(); }
    /// Units that wait, but to be issued alone.
    std::size_t suspects() const { return suspects_.size(); }
    /// Paths of all units that wait, suspects aside.
    std::uint64_t waiting_paths() const { return waiting_paths_; }
    std::size_t outstanding() const { return holders_.size(); }
    std::size_t outstanding(int worker) const;
    /// Paths of the units that a worker has.
    std::uint64_t outstanding_paths(int worker) const;
    /// Copies that were issued, and results that came too late.
    std::uint64_t copies() const { return copies_; }
    /// Paths of a unit: chains count as one each.
    std::uint64_t paths(const WorkUnit& unit) const;
    /// Sum of the units' weights: of all, and of those done.
    std::uint64_t total() const { return total_; }
    std::uint64_t done() const { return done_; }

  private:
    /// Who has a unit: the first, and who got a copy (-1: nobody).
    struct Holders {
        int first = -1, second = -1;
        std::uint64_t issued = 0;  ///< the first's number among all that were issued
        bool has(int worker) const { return first == worker || second == worker; }
        int other_than(int worker) const { return first == worker ? second : first; }
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
    std::map<WorkUnit, Holders> holders_;       ///< units that were issued
    std::map<WorkUnit, std::set<int>> deaths_;  ///< workers that had a unit when they were lost
    std::set<std::pair<int, WorkUnit>> superseded_, told_;
    /// What a worker has.
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
