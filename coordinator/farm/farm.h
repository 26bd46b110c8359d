// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/timer.h"
#include "common/comm/broadcast_chain.h"
#include "common/comm/channel.h"
#include "common/config/job.h"
#include "coordinator/farm/collector.h"
#include "coordinator/farm/ledger.h"
#include "coordinator/farm/roster.h"

namespace treefarm {

/// Time limits of the communication with workers, seconds.
struct FarmLimits {
    double gather = 20.0;  ///< wait at the start for workers that have not said hello
    double lost = 2.0;     ///< least silence after which a worker counts as lost; ten heartbeats if that is longer
    double dismiss = 5.0;  ///< wait at the end for good-byes
    double grace = 15.0;   ///< time without any worker before the render fails, if one may come back
    double asking = 0.2;   ///< window in which requests for the same tree or scene are served together
    double heard = 25.0;   ///< silence of this process after which its workers may have left (they wait 30 s)
};

/// Failure of a render that has no worker left.
class NoWorkerLeft : public RunError {
  public:
    NoWorkerLeft(const std::string& message, bool was_stopped) : RunError(message), was_stopped_(was_stopped) {}
    /// Whether this process was stopped for so long that its workers may have left for that.
    bool was_stopped() const { return was_stopped_; }

  private:
    bool was_stopped_;
};

/// Number of a job within one allocation, with the workers that are missing.
struct JobTurn {
    std::uint32_t number = 0;  ///< 0: the only job; from 1 on: workers stay, and are told to join this one
    std::set<int> absent;      ///< peers lost in an earlier job, which are not waited for
    std::set<int> left{};      ///< peers that left in an earlier job and only wait to be dismissed
};

/// The workers of a render from the coordinator's side: members, issued units, results. Driven by step(), which never
/// blocks on one worker.
class Farm {
  public:
    /// `scene`: encoded. `fingerprint`: this program's; workers with another one are refused.
    Farm(Channel& channel, const Job& job, Bytes scene, std::uint64_t fingerprint, const Log& log,
         const FarmLimits& limits = {}, const JobTurn& turn = {});

    /// Waits for the workers' hellos, before anything large is sent. Throws RunError if no worker is usable.
    /// `interrupted` is polled; true ends the wait.
    void gather(const std::function<bool()>& interrupted);

    /// Sets the text before and after a unit's name in the command that traces it alone, for poison units.
    void debug_by(std::string command, std::string options) {
        debug_command_ = std::move(command);
        debug_options_ = std::move(options);
    }

    /// Whether pixels may be negative, as in a film that is_signed(); otherwise negative ones are refused.
    void allow_negative(bool allowed) { negative_allowed_ = allowed; }

    /// Refuses guests whose host has less memory than this, in bytes.
    void require_of_guests(std::uint64_t bytes) { guest_bytes_ = bytes; }

    /// Announces a pass and sends its tree along the chain of present workers; before the first pass, the scene.
    /// `partial`: results from before a resume, or nullptr.
    void begin_pass(const PassPlan& plan, const AnyModel& tree, Bytes encoded_tree, int width, int height,
                    const PartialPass* partial = nullptr);
    /// Copies the pass's results so far, with its poison units.
    void fill(PartialPass& partial) const;

    /// Handles messages, issues units and watches for silence; rests if nothing happened. Throws NoWorkerLeft if no
    /// worker is left, and none has come back within FarmLimits::grace.
    void step();

    bool has_pass() const { return ledger_ != nullptr; }
    bool pass_complete() const { return ledger_ && ledger_->complete(); }
    const Collector& collector() const { return *collector_; }
    std::vector<PixelEstimate> take_pixels() { return collector_->take_pixels(); }  ///< of the complete pass, once
    /// Evidence of the complete pass, once per owner.
    Blocks take_evidence(EvidenceOwner owner) { return collector_->take_evidence(owner); }
    AovPixels take_aovs() { return collector_->take_aovs(); }  ///< of the complete pass, once
    const Ledger& ledger() const { return *ledger_; }
    /// Seconds from begin_pass() until the last present worker requested units.
    double broadcast_seconds() const { return broadcast_seconds_; }
    /// Seconds from begin_pass() until the first worker's request; in the first pass this includes preparing the scene.
    double first_request_seconds() const { return first_request_seconds_; }
    const Roster& roster() const { return roster_; }
    /// Peers lost in this job or an earlier one that are not back.
    std::set<int> lost_peers() const;
    /// Peers that left in this job or an earlier one.
    std::set<int> left_peers() const;
    /// Sends due heartbeats; to be called between long computations.
    void beat();
    /// Runs a computation of any length in the background, while heartbeats continue. Rethrows its exceptions.
    void beat_during(const std::function<void()>& work);
    /// Number of units that were issued again.
    std::uint64_t reissued_units() const { return reissued_units_; }
    /// Number of dropped results: from lost incarnations, or later than another worker's result for the same units.
    std::uint64_t dropped_results() const { return dropped_results_; }
    /// Number of units of which a second worker got a copy because the first was slow.
    std::uint64_t copied_units() const { return copied_units_ + (ledger_ ? ledger_->copies() : 0); }
    /// Number of invalid messages.
    std::uint64_t bad_messages() const { return bad_messages_; }
    /// Rays of all workers in their present incarnations, by their heartbeats.
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
    bool may_come_back() const;  ///< a worker that is not present
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
    double pass_result_seconds() const;
    double copy_gain(const Member& member, int holder, const WorkUnit& unit, const Speeds& all);
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
    std::uint64_t guest_bytes_ = 0;
    bool scene_sent_ = false;  ///< later workers get it at once
    std::optional<OpenPass> pass_;
    std::unique_ptr<Ledger> ledger_;
    std::unique_ptr<Collector> collector_;
    std::vector<int> not_ready_;  ///< peers that have not yet requested units of this pass
    bool requested_ = false;      ///< some worker has requested units
    double pass_began_ = 0, first_request_seconds_ = 0, broadcast_seconds_ = 0, last_beat_ = 0;
    double longest_silence_ = 0;                         ///< longest time between two heartbeats of this process
    double listened_ = 0;                                ///< time at which step() last polled for messages
    std::optional<double> alone_since_;                  ///< time since when no worker is present
    std::set<int> told_job_;                             ///< peers that were told to join this job
    std::map<std::pair<int, BlobName>, double> copied_;  ///< time at which a worker got a copy of its own
    /// Requests for a blob: the first missing byte of each peer, and the time of the first request.
    struct BlobRequests {
        std::map<int, std::uint64_t> offsets;
        double since = 0;
    };
    std::map<Blob, BlobRequests> requests_;
    std::string last_failure_;
    /// time at which the pass had no more units to issue; time of the last search for slow workers
    double ended_ = 0, last_look_ = 0;
    std::uint64_t reissued_units_ = 0, copied_units_ = 0, dropped_results_ = 0, bad_messages_ = 0;
};

/// Sends one message to every peer.
template <class M>
void tell_workers(Channel& channel, const M& message) {
    const auto payload = std::make_shared<const Bytes>(encode(message));
    for (const int peer : channel.peers())
        channel.send(peer, payload);
    channel.drained();  // messages are sent only while the channel is polled
}

/// Dismisses every worker, also those that never said hello, and waits up to `patience` seconds for the good-byes of
/// those not known as lost. Returns whether all but guests said good-bye, so that the message layer can be shut down.
bool dismiss_workers(Channel& channel, const std::set<int>& lost, double patience);

}  // namespace treefarm
