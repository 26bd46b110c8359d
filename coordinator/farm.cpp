#include "coordinator/farm.h"

#include <algorithm>
#include <utility>

#include "common/base/hash.h"
#include "common/comm/rest.h"
#include "common/config/job_reader.h"

namespace treefarm {

namespace {

constexpr double kLostHeartbeats = 10.0;

/// While fewer units are left than this per thread, they are issued in quarters.
constexpr std::size_t kShrinkUnitsPerThread = 2;

/// While more are left, and all are long, workers have enough to trace.
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
    const auto workers = static_cast<std::size_t>(channel_.peer_count() - 1);
    const std::size_t expected = std::max<std::size_t>(1, workers - turn_.absent.size());
    if (turn_.number > 0)
        for (int peer = 1; peer < channel_.peer_count(); ++peer)
            tell(peer, Rejoin{turn_.number});
    const Timer timer;
    while (roster_.members().size() < expected && timer.seconds() < limits_.gather && !interrupted())
        step();
    if (interrupted()) return;
    if (roster_.present_count() == 0)
        throw RunError(last_failure_.empty() ? "no worker said hello" : "no worker can be used: " + last_failure_);
    if (roster_.present_count() < expected)
        log_->warn("going on with {} of {} workers; the others may join later", roster_.present_count(), expected);
    if (turn_.number > 0)  // nor need later jobs wait for those that did not come
        for (int peer = 1; peer < channel_.peer_count(); ++peer)
            if (!roster_.find(peer)) turn_.absent.insert(peer);
    gathered_ = true;
    send_blob(Blob::scene, 0, chain_without_scene());
}

void Farm::begin_pass(const PassPlan& plan, const SdTree& tree, Bytes encoded_tree, int width, int height) {
    const std::uint64_t hash = hash_bytes(encoded_tree);
    pass_ = OpenPass{plan, std::move(encoded_tree), hash};
    ledger_ = std::make_unique<Ledger>(plan, width, height, job_.farm.tile_size);
    pass_began_ = clock_.seconds();
    first_request_seconds_ = broadcast_seconds_ = 0;
    requested_ = false;
    not_ready_.clear();
    for (Member* member : roster_.present()) {
        member->credit = 0;
        not_ready_.push_back(member->peer);
        announce(member->peer);
    }
    send_blob(Blob::tree, 0, chain_of_present());
    // Its sums take a while to make, as the workers do to unpack the tree.
    collector_ = std::make_unique<Collector>(plan, tree, width, height);
}

void Farm::announce(int peer) {
    tell(peer, PassBegin{pass_->plan, pass_->tree.size(), pass_->tree_hash});
}

void Farm::send_blob(Blob blob, std::uint64_t offset, std::span<const std::uint32_t> chain) {
    const BlobName name{blob, turn_.number, blob == Blob::tree ? pass_->plan.index : 0};
    send_along_chain(channel_, name, blob == Blob::tree ? pass_->tree : scene_, offset, chain);
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
    // Between steps the caller combines, refines and writes, and a message that waits may need more than one look.
    roster_.excuse(clock_.seconds() - listened_);
    bool busy = false;
    while (const auto message = channel_.poll()) {
        busy = true;
        take(*message);
        if (pass_complete()) break;
    }
    for (Member* member : roster_.overdue(clock_.seconds()))
        give_up(*member, "was silent for too long");
    if (gathered_ && roster_.present_count() == 0)
        throw RunError("no worker is left" + (last_failure_.empty() ? "" : ": " + last_failure_));
    beat();
    if (!busy) rest(channel_, calm());
    listened_ = clock_.seconds();
}

bool Farm::calm() const {
    return pass_ && not_ready_.empty() && pass_->plan.has_long_units(job_.farm.tile_size) &&
           ledger_->waiting() > kCalmUnitsPerThread * roster_.thread_count();
}

void Farm::beat() {
    const double now = clock_.seconds();
    if (now - last_beat_ < job_.farm.heartbeat_seconds) return;
    last_beat_ = now;
    for (int peer = 1; peer < channel_.peer_count(); ++peer) {
        const Member* member = roster_.find(peer);
        if (!member || member->state != MemberState::lost) tell(peer, Heartbeat{});
    }
}

void Farm::take(const Received& received) {
    const int peer = received.peer;
    try {
        Message message = decode(received.bytes);
        std::visit(Overloads{
                       [&](const Hello& m) { on(peer, m); },
                       [&](const Resend& m) { on(peer, m); },
                       [&](const Want& m) { on(peer, m); },
                       [&](Result& m) { on(peer, std::move(m)); },
                       [&](const Heartbeat& m) {
                           if (Member* member = hear(peer, m.incarnation)) member->progress = m;
                       },
                       [&](const Failure& m) { on(peer, m); },
                       [&](const Bye& m) {
                           if (Member* member = hear(peer, m.incarnation)) give_up(*member, "left by itself");
                       },
                       [&](const auto&) { throw FormatError("a message that the coordinator sends, not receives"); },
                   },
                   message);
    } catch (const FormatError& error) {
        last_failure_ = "bad message from worker " + std::to_string(peer) + ": " + error.what();
        Member* member = roster_.find(peer);
        if (member && member->state == MemberState::present) {
            give_up(*member, std::string("sent a bad message: ") + error.what());
            member->asked_back = true;  // not again: it may do so for ever
        } else {
            log_->warn("{}", last_failure_);
        }
    }
}

Member* Farm::hear(int peer, std::uint64_t incarnation) {
    if (Member* member = roster_.hear(peer, incarnation, clock_.seconds())) return member;
    Member* member = roster_.find(peer);
    if (member && member->state == MemberState::lost && member->hello.incarnation == incarnation &&
        !member->asked_back) {
        log_->info("worker {} is back: it may join again", peer);
        member->asked_back = true;
        tell(peer, Rejoin{turn_.number});
    }
    return nullptr;
}

void Farm::on(int peer, const Hello& m) {
    if (m.job != turn_.number) return;  // of an earlier job; the answer to this one's rejoin is on its way
    if (Member* earlier = roster_.find(peer); earlier && earlier->state == MemberState::present)
        give_up(*earlier, "started anew");
    if (m.fingerprint != fingerprint_) {
        refuse(peer, m,
               "its program or floating-point state differs (fingerprint " + hash_text(m.fingerprint) +
                   ", the coordinator's is " + hash_text(fingerprint_) + "): start the same build everywhere");
        return;
    }
    if (m.threads == 0) {
        refuse(peer, m, "it has no threads to trace with");
        return;
    }
    roster_.admit(peer, m, clock_.seconds());
    log_->debug("worker {} on {} with {} threads", peer, m.host, m.threads);
    tell(peer, Welcome{static_cast<std::uint32_t>(peer), job_.farm.heartbeat_seconds, job_text_, scene_hash_,
                       turn_.number > 0});
    if (!gathered_) return;
    const std::uint32_t only[] = {static_cast<std::uint32_t>(peer)};
    if (m.scene_hash != scene_hash_) send_blob(Blob::scene, 0, only);
    if (!pass_) return;
    announce(peer);
    send_blob(Blob::tree, 0, only);
}

void Farm::refuse(int peer, const Hello& m, const std::string& reason) {
    roster_.admit(peer, m, clock_.seconds()).state = MemberState::refused;
    last_failure_ = "worker " + std::to_string(peer) + " on " + m.host + " was refused: " + reason;
    log_->error("{}", last_failure_);
    tell(peer, Refuse{reason});
}

void Farm::on(int peer, const Resend& m) {
    const Member* member = roster_.find(peer);
    if (!member || member->state != MemberState::present || !gathered_) return;
    if (m.job != turn_.number) return;
    if (m.blob == Blob::tree && (!pass_ || m.epoch != pass_->plan.index)) return;
    log_->debug("worker {} asks again for a {} from byte {}", peer, m.blob == Blob::tree ? "tree" : "scene", m.offset);
    const std::uint32_t only[] = {static_cast<std::uint32_t>(peer)};
    send_blob(m.blob, m.offset, only);
}

void Farm::on(int peer, const Want& m) {
    Member* member = hear(peer, m.incarnation);
    if (!member || !pass_ || m.pass != pass_->plan.index) return;
    if (!std::exchange(requested_, true)) first_request_seconds_ = clock_.seconds() - pass_began_;
    if (std::erase(not_ready_, peer) > 0 && not_ready_.empty()) broadcast_seconds_ = clock_.seconds() - pass_began_;
    member->credit += m.units;
    if (!serve(*member)) tell(peer, Work{m.pass, {}});
}

/// Gives a worker its share of what is left, by its threads: nobody takes all of a short queue. One that got less than
/// it wants asks again when it has finished something. False if nothing is left.
bool Farm::serve(Member& member) {
    const std::size_t waiting = ledger_->waiting(), threads = roster_.thread_count();
    const std::size_t share = (waiting * member.hello.threads + threads - 1) / threads;
    const std::size_t count = std::min<std::size_t>(member.credit, share);
    Work work{pass_->plan.index, ledger_->issue(member.peer, count, kShrinkUnitsPerThread * threads)};
    if (work.units.empty()) return false;
    member.credit -= static_cast<std::uint32_t>(work.units.size());
    tell(member.peer, work);
    return true;
}

void Farm::on(int peer, Result&& m) {
    if (!hear(peer, m.incarnation)) {
        ++dropped_results_;
        log_->warn("a result of worker {} came too late and was dropped: its work was issued again", peer);
        return;
    }
    if (!collector_ || !collector_->take(peer, std::move(m), *ledger_))
        throw FormatError("a result for work that the worker does not have");
}

void Farm::on(int peer, const Failure& m) {
    Member* member = hear(peer, m.incarnation);
    if (!member) return;
    last_failure_ = "worker " + std::to_string(peer) + " on " + member->hello.host + ": " + m.text;
    give_up(*member, "failed: " + m.text);
    member->asked_back = true;  // it cannot go on
}

void Farm::give_up(Member& member, const std::string& why) {
    member.state = MemberState::lost;
    const std::size_t units = ledger_ ? ledger_->reclaim(member.peer) : 0;
    reissued_units_ += units;
    log_->error("worker {} on {} {}; {} units are issued again", member.peer, member.hello.host, why, units);
    if (std::erase(not_ready_, member.peer) > 0 && not_ready_.empty())
        broadcast_seconds_ = clock_.seconds() - pass_began_;
    if (units == 0) return;
    for (Member* other : roster_.present())
        if (other->credit > 0) serve(*other);
}

std::set<int> Farm::lost_peers() const {
    std::set<int> lost = turn_.absent;
    for (const auto& [peer, member] : roster_.members()) {
        if (member.state == MemberState::lost)
            lost.insert(peer);
        else
            lost.erase(peer);
    }
    return lost;
}

std::uint64_t Farm::rays_traced() const {
    std::uint64_t rays = 0;
    for (const auto& [peer, member] : roster_.members())
        rays += member.progress.rays;
    return rays;
}

}  // namespace treefarm
