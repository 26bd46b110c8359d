// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "common/base/hash.h"
#include "common/math/saturating.h"
#include "coordinator/farm/farm.h"

// Handling of each message. Any peer may send any bytes at any time: an invalid message costs its sender its
// membership, and never the farm's process, memory or pixels.

namespace treefarm {

namespace {

/// Limit of the units that a worker may request.
constexpr std::uint32_t kMostCredit = 1u << 20;

/// Incarnations of one worker process, after which it counts as failing for good.
constexpr std::uint32_t kMostLives = 1000;

/// Number of messages of one kind that are logged.
constexpr std::uint64_t kMostLogged = 20;

/// Limit of the seconds that a worker may claim, by its threads' time since the pass began.
constexpr double kSecondsMargin = 60.0, kSecondsRatio = 2.0;

void check_seconds(const TraceStats& stats, double most) {
    double longest = std::max({stats.trace_seconds, stats.splat_seconds, stats.busy_seconds});
    for (const double seconds : stats.phase_seconds)
        longest = std::max(longest, seconds);
    if (longest > most) throw FormatError("more seconds than its threads have had");
}

}  // namespace

void Farm::take(const Received& received) {
    const int peer = received.peer;
    Message message;
    try {
        message = decode(received.bytes);
    } catch (const std::exception& error) {  // also a count for which memory does not suffice
        on_bad_message(peer, error.what());
        return;
    }
    try {
        std::visit(Overloads{
                       [&](const Hello& m) { on(peer, m); },
                       [&](const Resend& m) { on(peer, m); },
                       [&](const Want& m) { on(peer, m); },
                       [&](Result& m) { on(peer, std::move(m)); },
                       [&](const Heartbeat& m) {
                           if (Member* member = hear(peer, m.incarnation)) on(*member, m);
                       },
                       [&](const Failure& m) { on(peer, m); },
                       [&](const Bye& m) {
                           if (Member* member = hear(peer, m.incarnation)) {
                               give_up(*member, MemberState::left, "leaves, as it was told");
                               // Processes of mpirun stay to its end: ending one would end all others.
                               if (channel_.is_guest(peer)) tell(peer, Leave{true});
                           }
                       },
                       [&](const auto&) { throw FormatError("a message that the coordinator sends, not receives"); },
                   },
                   message);
    } catch (const FormatError& error) {
        on_bad_message(peer, error.what());
    }
}

void Farm::on_bad_message(int peer, const std::string& why) {
    last_failure_ = "bad message from worker " + std::to_string(peer) + ": " + why;
    const bool log_it = ++bad_messages_ <= kMostLogged;
    Member* member = roster_.find(peer);
    if (member) ++member->bad_messages;
    if (member && member->state == MemberState::present)
        give_up(*member, MemberState::barred, "sent a bad message: " + why);  // it might repeat it without end
    else if (log_it)
        log_->warn("{}", last_failure_);
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
    if (m.job != turn_.number) {  // of an earlier job; the answer to this one's Rejoin is in flight
        if (told_job_.insert(peer).second) tell(peer, Rejoin{turn_.number});
        return;
    }
    if (Member* earlier = roster_.find(peer)) {
        if (earlier->state == MemberState::barred) return;
        if (earlier->lives >= kMostLives) throw FormatError("a worker that restarts without end");
        if (earlier->state == MemberState::present) {
            if (earlier->hello.incarnation == m.incarnation) return;
            give_up(*earlier, MemberState::lost, "started anew");
        }
    }
    if (m.fingerprint != fingerprint_) {
        refuse(peer, m,
               "its program or floating-point state differs (fingerprint " + hash_text(m.fingerprint) +
                   ", the coordinator's is " + hash_text(fingerprint_) +
                   "): start the same build everywhere; treefarm --version tells them apart");
        return;
    }
    if (m.threads == 0) {
        refuse(peer, m, "it has no threads to trace with");
        return;
    }
    if (channel_.is_guest(peer) && m.memory > 0 && m.memory < guest_bytes_) {
        refuse(peer, m,
               "its host has " + std::to_string(m.memory >> 20) + " MiB of memory left, and it is expected to need " +
                   std::to_string(guest_bytes_ >> 20) + " MiB (farm.memory_check)");
        return;
    }
    roster_.admit(peer, m, clock_.seconds()).is_guest = channel_.is_guest(peer);
    if (ledger_) ledger_->forgive(peer);
    log_->debug("worker {} on {} with {} threads", peer, m.host, m.threads);
    tell(peer, Welcome{static_cast<std::uint32_t>(peer), job_.farm.heartbeat_seconds, job_text_, scene_hash_,
                       scene_.size(), turn_.number > 0});
    if (!scene_sent_) return;
    const std::uint32_t only[] = {static_cast<std::uint32_t>(peer)};
    if (m.scene_hash != scene_hash_ && may_have_copy(Blob::scene, peer)) send_blob(Blob::scene, 0, only);
    if (!pass_) return;
    announce(peer);
    if (may_have_copy(Blob::tree, peer)) send_blob(Blob::tree, 0, only);
}

void Farm::refuse(int peer, const Hello& m, const std::string& reason) {
    roster_.admit(peer, m, clock_.seconds()).state = MemberState::refused;
    last_failure_ = "worker " + std::to_string(peer) + " on " + m.host + " was refused: " + reason;
    log_->error("{}", last_failure_);
    tell(peer, Refuse{reason});
}

void Farm::on(int peer, const Resend& m) {
    const Member* member = roster_.find(peer);
    if (!member || member->state != MemberState::present || !scene_sent_) return;
    if (m.job != turn_.number) return;
    if (m.blob == Blob::tree && (!pass_ || m.epoch != pass_->plan.index)) return;
    log_->debug("worker {} asks again for a {} from byte {}", peer, m.blob == Blob::tree ? "tree" : "scene", m.offset);
    BlobRequests& requests = requests_[m.blob];
    if (requests.offsets.empty()) requests.since = clock_.seconds();
    requests.offsets.try_emplace(peer, m.offset);
}

void Farm::on(int peer, const Want& m) {
    Member* member = hear(peer, m.incarnation);
    if (!member || !pass_ || m.pass != pass_->plan.index) return;
    if (!std::exchange(requested_, true)) first_request_seconds_ = clock_.seconds() - pass_began_;
    if (std::erase(not_ready_, peer) > 0 && not_ready_.empty()) broadcast_seconds_ = clock_.seconds() - pass_began_;
    member->credit += std::min(m.units, kMostCredit - member->credit);
    member->queued = m.queued;
    if (!serve(*member, speeds()) && !std::exchange(member->told_end, true)) tell(peer, Work{m.pass, {}});
}

void Farm::on(Member& member, const Heartbeat& m) {
    member.progress = m;
    member.progress.rays = std::min(m.rays, kMostClaim);
}

void Farm::on(int peer, Result&& m) {
    Member* member = hear(peer, m.incarnation);
    if (!member) {
        if (++dropped_results_ <= kMostLogged)
            log_->warn("a result of worker {} came too late and was dropped: its work was issued again", peer);
        return;
    }
    if (pass_ && m.pass < pass_->plan.index) {  // others were faster, and the pass is complete
        ++dropped_results_;
        return;
    }
    check_seconds(m.stats, kSecondsMargin + kSecondsRatio * member->hello.threads * (clock_.seconds() - pass_began_));
    const std::uint64_t had = ledger_ ? ledger_->outstanding_paths(peer) : 0;
    const Verdict verdict = collector_ ? collector_->take(peer, std::move(m), *ledger_) : Verdict::protocol_error;
    if (verdict == Verdict::protocol_error) throw FormatError("a result for work that the worker does not have");
    const std::uint64_t paths = verdict == Verdict::accepted ? had - ledger_->outstanding_paths(peer) : 0;
    if (const std::size_t more = ledger_->outstanding(peer); paths > 0 || more == 0)
        member->speed.deliver(clock_.seconds(), paths, more > 0);
    if (verdict == Verdict::late) {
        ++dropped_results_;
        log_->debug("a result of worker {} was dropped: others were quicker", peer);
    }
    member->queued = std::min(member->queued, ledger_->outstanding_paths(peer));
    for (Member* other : roster_.present())
        if (std::vector<WorkUnit> done = ledger_->take_superseded(other->peer); !done.empty())
            tell(other->peer, Drop{pass_->plan.index, std::move(done)});
    if (ledger_->complete()) {  // whoever still has units has delivered none of them
        for (Member* other : roster_.present())
            other->speed.deliver(clock_.seconds(), 0, false);
        return;
    }
    if (ledger_->waiting() == 0 || ledger_->outstanding(peer) == 0) serve_all();
}

void Farm::on(int peer, const Failure& m) {
    Member* member = hear(peer, m.incarnation);
    if (!member) return;
    last_failure_ = "worker " + std::to_string(peer) + " on " + member->hello.host + ": " + m.text;
    give_up(*member, MemberState::barred, "failed: " + m.text);  // it cannot continue
}

}  // namespace treefarm
