// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/log.h"
#include "common/base/timer.h"
#include "common/comm/broadcast_chain.h"
#include "common/comm/channel.h"
#include "common/config/job.h"
#include "coordinator/collector.h"
#include "coordinator/ledger.h"
#include "coordinator/roster.h"

namespace treefarm {

/// Limits of the conversation with workers, seconds.
struct FarmLimits {
    double gather = 20.0;  ///< how long the start waits for workers that have not said hello
    double lost = 2.0;     ///< least silence after which a worker is given up; ten heartbeats if that is longer
    double dismiss = 5.0;  ///< how long the end waits for good-byes
    double grace = 15.0;   ///< how long nobody at all may be there, where somebody may come back
    double asking = 0.2;   ///< in which workers that ask for the same tree or scene are served together
};

/// A job's place among those of one allocation.
struct JobTurn {
    std::uint32_t number = 0;  ///< 0: the only one; from 1 on: workers stay, and are told to join this one
    std::set<int> absent;      ///< peers that an earlier job lost: nobody waits for them
    std::set<int> left{};      ///< peers that left an earlier job: they only wait to be dismissed
};

/// The workers, as the coordinator talks to them: who is there, who has what, what came back. One step() at a time,
/// never blocking on anybody.
class Farm {
  public:
    /// `scene`: encoded. `fingerprint`: this program's own; a worker that differs is refused.
    Farm(Channel& channel, const Job& job, Bytes scene, std::uint64_t fingerprint, const Log& log,
         const FarmLimits& limits = {}, const JobTurn& turn = {});

    /// Waits for the workers' hellos; nothing large is sent yet. Throws RunError if none can be used. `interrupted` is
    /// asked now and then; true ends the wait.
    void gather(const std::function<bool()>& interrupted);

    /// What stands before and after a unit's name in the command that traces it alone: for units that killed workers.
    void debug_by(std::string command, std::string options) {
        debug_command_ = std::move(command);
        debug_options_ = std::move(options);
    }

    /// Whether pixels may be negative: those of a film that is_signed(). Otherwise they are refused.
    void allow_negative(bool allowed) { negative_allowed_ = allowed; }

    /// Announces a pass and sends its tree along the chain of those present; before the first one, the scene. `begun`:
    /// what an earlier life of the render has of it, or nullptr.
    void begin_pass(const PassPlan& plan, const AnyModel& tree, Bytes encoded_tree, int width, int height,
                    const PartialPass* partial = nullptr);
    /// Sets what has come in of the pass, and whom it cost.
    void fill(PartialPass& partial) const;

    /// Takes what has arrived, hands out work, watches for silence; rests if nothing happened. Throws RunError when no
    /// worker is left, and none has come back within FarmLimits::grace.
    void step();

    bool has_pass() const { return ledger_ != nullptr; }
    bool pass_complete() const { return ledger_ && ledger_->complete(); }
    const Collector& collector() const { return *collector_; }
    std::vector<PixelEstimate> take_pixels() { return collector_->take_pixels(); }  ///< of the complete pass, once
    AovPixels take_aovs() { return collector_->take_aovs(); }                       ///< of it, once
    const Ledger& ledger() const { return *ledger_; }
    /// Seconds from begin_pass() until the last of those present asked for work.
    double broadcast_seconds() const { return broadcast_seconds_; }
    /// Seconds from begin_pass() until the first of them did: before the first pass that takes reading in the scene.
    double first_request_seconds() const { return first_request_seconds_; }
    const Roster& roster() const { return roster_; }
    /// Peers that were given up, in this job or an earlier one, and are not back.
    std::set<int> lost_peers() const;
    /// Peers that left, in this job or an earlier one.
    std::set<int> left_peers() const;
    /// Sends heartbeats that are due: call it between long computations.
    void beat();
    /// Runs a computation of any length aside, while workers go on hearing from here. What it throws leaves this.
    void beat_during(const std::function<void()>& work);
    /// Units that were issued again.
    std::uint64_t reissued_units() const { return reissued_units_; }
    /// Results that came from lost lives, or after another worker's of the same units, and were dropped.
    std::uint64_t dropped_results() const { return dropped_results_; }
    /// Units that a second worker was given because the first was slow.
    std::uint64_t copied_units() const { return copied_units_ + (ledger_ ? ledger_->copies() : 0); }
    /// Messages that were no messages, or said what cannot be.
    std::uint64_t bad_messages() const { return bad_messages_; }
    /// Rays of all workers in their present lives, as their heartbeats say.
    std::uint64_t rays_traced() const;

  private:
    struct OpenPass {
        PassPlan plan;
        Bytes tree;
        std::uint64_t tree_hash = 0;
    };

    void open_books(const AnyModel& tree, int width, int height, const PartialPass* partial);
    bool calm() const;  ///< all workers have enough to trace
    void take(const Received& received);
    void on_bad_message(int peer, const std::string& why);
    void watch_for_silence();
    void watch_for_slowness();
    std::string blame(const WorkUnit& unit) const;
    std::string why_nobody() const;
    std::pair<WorkUnit, std::size_t> worst_poison_unit() const;
    bool may_come_back() const;  ///< somebody who is not there now
    void on(int peer, const Hello& m);
    void on(int peer, const Resend& m);
    void on(int peer, const Want& m);
    void on(int peer, Result&& m);
    void on(Member& member, const Heartbeat& m);
    void on(int peer, const Failure& m);
    Member* hear(int peer, std::uint64_t incarnation);
    void refuse(int peer, const Hello& m, const std::string& reason);
    void give_up(Member& member, MemberState state, const std::string& why);
    void announce(int peer);
    Speeds speeds() const;
    bool serve(Member& member, const Speeds& all);
    bool serve_copies(Member& member, const Speeds& all);
    void serve_all();
    void tell_end();
    BlobName name_of(Blob blob) const;
    void send_blob(Blob blob, std::uint64_t offset, std::span<const std::uint32_t> peers);
    bool may_have_copy(Blob blob, int peer);
    void serve_requests();
    std::vector<std::uint32_t> chain_of_present();
    std::vector<std::uint32_t> chain_without_scene();

    template <class M>
    void tell(int peer, const M& message) {
        channel_.send(peer, std::make_shared<const Bytes>(encode(message)));
    }

    Channel& channel_;
    const Job job_;
    const std::string job_text_;
    const Bytes scene_;
    const std::uint64_t scene_hash_;
    const std::uint64_t fingerprint_;
    const Log log_;
    const FarmLimits limits_;
    JobTurn turn_;
    const Timer clock_;
    Roster roster_;
    std::string debug_command_ = "treefarm render SCENE --debug-sample", debug_options_;
    bool negative_allowed_ = false;
    bool scene_sent_ = false;  ///< whoever comes from now on gets it at once
    std::optional<OpenPass> pass_;
    std::unique_ptr<Ledger> ledger_;
    std::unique_ptr<Collector> collector_;
    std::vector<int> not_ready_;  ///< peers that have not yet asked for work of this pass
    bool requested_ = false;      ///< somebody has
    double pass_began_ = 0, first_request_seconds_ = 0, broadcast_seconds_ = 0, last_beat_ = 0;
    double listened_ = 0;                                ///< when step() last looked for messages
    std::optional<double> alone_since_;                  ///< nobody has been there since
    std::set<int> told_job_;                             ///< peers that were told to join this one
    std::map<std::pair<int, BlobName>, double> copied_;  ///< when a worker got a copy of its own
    /// Who asked for what, from which byte on, and since when somebody waits.
    struct BlobRequests {
        std::map<int, std::uint64_t> offsets;
        double since = 0;
    };
    std::map<Blob, BlobRequests> requests_;
    std::string last_failure_;
    double ended_ = 0, last_look_ = 0;  ///< when nothing of the pass was left to hand out; for who is slow
    std::uint64_t reissued_units_ = 0, copied_units_ = 0, dropped_results_ = 0, bad_messages_ = 0;
};

/// Sends every worker one message, whoever is there.
template <class M>
void tell_workers(Channel& channel, const M& message) {
    const auto payload = std::make_shared<const Bytes>(encode(message));
    for (const int peer : channel.peers())
        channel.send(peer, payload);
    channel.drained();  // they move only when they are looked at
}

/// Sends every worker away, those included that never said hello, and waits up to `patience` seconds for the good-byes
/// of those not known as lost. Returns whether all but guests went in order, so that the message layer can be shut
/// down.
bool dismiss_workers(Channel& channel, const std::set<int>& lost, double patience);

}  // namespace treefarm
