// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/farm.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "common/base/hash.h"
#include "common/comm/rest.h"
#include "common/config/aov_list.h"
#include "common/config/job_reader.h"
#include "coordinator/farm/pulse.h"
#include "coordinator/farm/result_pace.h"

namespace treefarm {

namespace {

constexpr double kLostHeartbeats = 10.0;

/// Least time between two copies of a tree or scene for one worker; workers request it again after five of silence.
constexpr double kResendHeartbeats = 2.0;

/// Messages handled before the farm's other duties, which a flood of messages must not starve.
constexpr int kMostLooks = 1024;

/// kSettleSeconds: delay after the last unit was issued until a worker with unsent units counts as slow; kLookSeconds:
/// interval of the search for such workers.
constexpr double kSettleSeconds = 0.05, kLookSeconds = 0.02;

/// Waiting units per thread above which workers have enough to trace, if all units are long.
constexpr std::size_t kCalmUnitsPerThread = 4;

}  // namespace

Farm::Farm(Channel& channel, const Job& job, Bytes scene, std::uint64_t fingerprint, const Log& log,
           const FarmLimits& limits, const JobTurn& turn)
    : channel_(channel),
      job_(job),
      job_text_(write_job(job)),
      scene_(std::move(scene)),
      scene_hash_(hash_bytes(scene_)),
      fingerprint_(fingerprint),
      log_(log),
      limits_(limits),
      turn_(turn),
      roster_(std::max(limits.lost, kLostHeartbeats * job.farm.heartbeat_seconds)) {}

void Farm::gather(const std::function<bool()>& interrupted) {
    const auto is_expected = [&](int peer) {
        return !channel_.is_guest(peer) && !turn_.absent.contains(peer) && !turn_.left.contains(peer);
    };
    std::size_t expected = 0;
    for (const int peer : channel_.peers())
        expected += is_expected(peer);
    // Guests are not waited for, unless there is nobody else.
    const auto all_are_there = [&] {
        std::size_t there = 0;
        for (const auto& [peer, member] : roster_.members())
            there += expected == 0 ? member.state == MemberState::present : is_expected(peer);
        return there >= std::max<std::size_t>(1, expected);
    };
    if (turn_.number > 0)
        for (const int peer : channel_.peers()) {
            tell(peer, Rejoin{turn_.number});
            told_job_.insert(peer);
        }
    const Timer timer;
    while (!all_are_there() && timer.seconds() < limits_.gather && !interrupted())
        step();
    if (interrupted()) return;
    if (roster_.present_count() == 0)
        throw RunError(last_failure_.empty() ? "no worker said hello" : "no worker can be used: " + last_failure_);
    if (roster_.present_count() < expected)
        log_->warn("going on with {} of {} workers; the others may join later", roster_.present_count(), expected);
    if (turn_.number > 0)  // later jobs do not wait for workers that never came
        for (const int peer : channel_.peers())
            if (!channel_.is_guest(peer) && !roster_.find(peer) && !turn_.left.contains(peer))
                turn_.absent.insert(peer);
}

void Farm::begin_pass(const PassPlan& plan, const AnyModel& tree, Bytes encoded_tree, int width, int height,
                      const PartialPass* partial) {
    const std::uint64_t hash = hash_bytes(encoded_tree);
    pass_ = OpenPass{plan, std::move(encoded_tree), hash};
    if (ledger_) copied_units_ += ledger_->copies();
    pass_began_ = clock_.seconds();
    first_request_seconds_ = broadcast_seconds_ = 0;
    requested_ = false;
    not_ready_.clear();
    copied_.clear();
    requests_.clear();
    for (Member* member : roster_.present()) {
        member->credit = 0;
        member->queued = 0;
        member->told_end = false;
        not_ready_.push_back(member->peer);
        announce(member->peer);
    }
    if (!std::exchange(scene_sent_, true)) send_blob(Blob::scene, 0, chain_without_scene());
    send_blob(Blob::tree, 0, chain_of_present());
    // Allocating sums takes time, as does unpacking the tree on the workers.
    open_books(tree, width, height, partial);
}

void Farm::open_books(const AnyModel& tree, int width, int height, const PartialPass* partial) {
    const PassPlan& plan = pass_->plan;
    const auto new_collector = [&] {
        return std::make_unique<Collector>(plan, tree, width, height, negative_allowed_, AovLayout(aov_requests(job_)));
    };
    collector_ = new_collector();
    try {
        if (partial) collector_->restore(*partial);
    } catch (const FormatError& error) {
        log_->warn("the partial results of pass {} are unusable ({}): it is traced again", plan.index, error.what());
        collector_ = new_collector();
        partial = nullptr;
    }
    ledger_ = std::make_unique<Ledger>(plan, width, height, job_.farm.tile_size, partial ? partial->done : DoneWork(),
                                       partial ? partial->poison_units : std::vector<PoisonUnit>());
}

void Farm::fill(PartialPass& partial) const {
    collector_->fill(partial);
    partial.poison_units = ledger_->poison_units();
}

void Farm::announce(int peer) {
    tell(peer, PassBegin{pass_->plan, pass_->tree.size(), pass_->tree_hash, pass_result_seconds()});
}

double Farm::pass_result_seconds() const {
    return result_seconds(job_.farm.update_seconds, pass_->plan.layers.splats.pixels, roster_.present_count());
}

BlobName Farm::name_of(Blob blob) const {
    return {blob, turn_.number, blob == Blob::tree ? pass_->plan.index : 0};
}

/// Sends a blob along a chain of the peers that can reach each other, and to each guest directly.
void Farm::send_blob(Blob blob, std::uint64_t offset, std::span<const std::uint32_t> peers) {
    std::vector<std::uint32_t> chain, guests;
    for (const std::uint32_t peer : peers)
        (channel_.is_guest(static_cast<int>(peer)) ? guests : chain).push_back(peer);
    const Bytes& bytes = blob == Blob::tree ? pass_->tree : scene_;
    send_along_chain(channel_, name_of(blob), bytes, offset, chain);
    send_to_each(channel_, name_of(blob), bytes, offset, guests);
}

/// Whether a peer may get a copy now. Copies in flight take memory here: a peer gets only one at a time, however often
/// it asks.
bool Farm::may_have_copy(Blob blob, int peer) {
    double& last = copied_.try_emplace({peer, name_of(blob)}, -1e9).first->second;
    if (clock_.seconds() - last < kResendHeartbeats * job_.farm.heartbeat_seconds) return false;
    last = clock_.seconds();
    return true;
}

/// Sends requested blobs. Workers behind one that died in the chain ask at about the same time: they get one copy,
/// along one chain.
void Farm::serve_requests() {
    for (auto& [blob, requests] : requests_) {
        if (requests.offsets.empty() || clock_.seconds() - requests.since < limits_.asking) continue;
        std::vector<std::uint32_t> chain;
        std::uint64_t offset = ~std::uint64_t{0};
        for (const auto& [peer, from] : requests.offsets) {
            const Member* member = roster_.find(peer);
            if (!member || member->state != MemberState::present) continue;
            // an earlier copy may be in flight
            if (channel_.unsent(peer) > kChunkBytes || !may_have_copy(blob, peer)) continue;
            chain.push_back(static_cast<std::uint32_t>(peer));
            offset = std::min(offset, from);
        }
        requests.offsets.clear();
        send_blob(blob, offset, chain);
    }
}

std::vector<std::uint32_t> Farm::chain_of_present() {
    std::vector<std::uint32_t> chain;
    for (const Member* member : roster_.present())
        chain.push_back(static_cast<std::uint32_t>(member->peer));
    return chain;
}

std::vector<std::uint32_t> Farm::chain_without_scene() {
    std::vector<std::uint32_t> chain;
    for (const Member* member : roster_.present())
        if (member->hello.scene_hash != scene_hash_) chain.push_back(static_cast<std::uint32_t>(member->peer));
    return chain;
}

void Farm::step() {
    // Between steps the caller combines, refines and writes, and messages may wait for more than one step.
    roster_.excuse(clock_.seconds() - listened_);
    longest_silence_ = std::max(longest_silence_, clock_.seconds() - last_beat_);
    bool busy = false;
    for (int looks = 0; looks < kMostLooks && !pass_complete(); ++looks) {
        const auto message = channel_.poll();
        if (!message) break;
        busy = true;
        take(*message);
    }
    serve_requests();
    watch_for_silence();
    watch_for_slowness();
    beat();
    if (!busy) rest(channel_, calm());
    listened_ = clock_.seconds();
}

/// Once no unit waits, looks at intervals for slow workers whose units idle workers could copy.
void Farm::watch_for_slowness() {
    if (!ledger_ || ledger_->complete() || ledger_->waiting() > 0) return;
    if (clock_.seconds() - last_look_ < kLookSeconds) return;
    last_look_ = clock_.seconds();
    serve_all();
}

bool Farm::calm() const {
    return pass_ && not_ready_.empty() && pass_->plan.has_long_units(job_.farm.tile_size) &&
           ledger_->waiting() > kCalmUnitsPerThread * roster_.thread_count();
}

void Farm::beat() {
    const double now = clock_.seconds();
    longest_silence_ = std::max(longest_silence_, now - last_beat_);
    if (now - last_beat_ < job_.farm.heartbeat_seconds) return;
    last_beat_ = now;
    for (const int peer : channel_.peers()) {
        const Member* member = roster_.find(peer);
        if (!member || member->state != MemberState::lost) tell(peer, Heartbeat{});
    }
    channel_.drained();  // messages are sent only while the channel is polled
}

void Farm::beat_during(const std::function<void()>& work) {
    run_in_background(work, [this] { beat(); });
}

Speeds Farm::speeds() const {
    std::map<int, WorkerRate> rates;
    for (const auto& [peer, member] : roster_.members())
        if (member.state == MemberState::present)
            rates[peer] = worker_rate(member.speed, member.hello.threads, ledger_->outstanding_paths(peer),
                                      pass_result_seconds(), clock_.seconds());
    return Speeds(rates);
}

/// Seconds that a copy of a unit at `member` is expected to save, if `holder` has it.
double Farm::copy_gain(const Member& member, int holder, const WorkUnit& unit, const Speeds& all) {
    constexpr double kHeartbeats = 3.0;  // a unit that may kill its workers is not copied from one that may be dead
    const Member* other = roster_.find(holder);
    if (ledger_->is_suspect(unit) && other &&
        clock_.seconds() - other->last_heard > kHeartbeats * job_.farm.heartbeat_seconds)
        return 0;
    return all.gain(member.peer, ledger_->paths(unit), holder, ledger_->outstanding_paths(holder));
}

/// Gives a worker its portion of the waiting units. A worker that got less than it requested requests again when it has
/// finished some. False if nothing is left, not even a copy of a slow worker's unit.
bool Farm::serve(Member& member, const Speeds& all) {
    if (ledger_->waiting() + ledger_->suspects() == 0) return serve_copies(member, all);
    const Portion portion = all.portion(member.peer, member.credit, member.queued, ledger_->waiting_paths());
    const bool nothing_waited = ledger_->waiting() == 0;
    Work work{pass_->plan.index, ledger_->issue(member.peer, portion, all.is_overdue(member.peer))};
    if (work.units.empty() && nothing_waited) return serve_copies(member, all);
    work.alone = ledger_->has_suspect(member.peer);
    for (const WorkUnit& unit : work.units)
        member.queued += ledger_->paths(unit);
    if (!work.units.empty()) {
        member.credit -= static_cast<std::uint32_t>(work.units.size());
        member.told_end = work.alone;
        member.speed.begin(clock_.seconds());
        tell(member.peer, work);
    }
    if (ledger_->waiting() == 0) tell_end();
    return true;
}

/// Tells every worker, once, that no unit waits: each then sends its finished units at once, which reveals the slow
/// ones.
void Farm::tell_end() {
    ended_ = clock_.seconds();
    for (Member* member : roster_.present())
        if (!std::exchange(member->told_end, true)) tell(member->peer, Work{pass_->plan.index, {}});
}

/// Gives an idle worker copies of slower workers' units.
bool Farm::serve_copies(Member& member, const Speeds& all) {
    if (member.credit == 0 || clock_.seconds() - ended_ < kSettleSeconds) return false;
    const auto gain = [&](int holder, const WorkUnit& unit) { return copy_gain(member, holder, unit, all); };
    Work work{pass_->plan.index, ledger_->issue_copies(member.peer, std::min(member.credit, member.hello.threads), gain,
                                                       all.is_overdue(member.peer))};
    if (work.units.empty()) return false;
    work.alone = true;
    member.speed.begin(clock_.seconds());
    member.credit -= static_cast<std::uint32_t>(work.units.size());
    tell(member.peer, work);
    return true;
}

void Farm::serve_all() {
    const Speeds all = speeds();
    for (Member* member : roster_.present())
        if (member->credit > 0) serve(*member, all);
}

void Farm::give_up(Member& member, MemberState state, const std::string& why) {
    member.state = state;
    const std::size_t units = ledger_ ? ledger_->reclaim(member.peer, state == MemberState::lost) : 0;
    reissued_units_ += units;
    log_->log(state == MemberState::left ? spdlog::level::info : spdlog::level::err,
              "worker {} on {} {}; {} units are issued again", member.peer, member.hello.host, why, units);
    if (std::erase(not_ready_, member.peer) > 0 && not_ready_.empty())
        broadcast_seconds_ = clock_.seconds() - pass_began_;
    if (const auto [unit, deaths] = worst_poison_unit(); deaths >= Ledger::kMostDeaths)
        throw RunError(std::to_string(deaths) + " workers were lost over " + blame(unit));
    if (units > 0) serve_all();
}

std::set<int> Farm::lost_peers() const {
    std::set<int> lost = turn_.absent;
    for (const auto& [peer, member] : roster_.members()) {
        if (member.state == MemberState::present || member.state == MemberState::refused ||
            member.state == MemberState::left)
            lost.erase(peer);
        else
            lost.insert(peer);
    }
    return lost;
}

std::set<int> Farm::left_peers() const {
    std::set<int> left = turn_.left;
    for (const auto& [peer, member] : roster_.members())
        if (member.state == MemberState::left) left.insert(peer);
    return left;
}

std::uint64_t Farm::rays_traced() const {
    std::uint64_t rays = 0;
    for (const auto& [peer, member] : roster_.members())
        rays += member.progress.rays;
    return rays;
}

}  // namespace treefarm
