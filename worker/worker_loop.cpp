// SPDX-License-Identifier: Apache-2.0
#include "worker/worker_loop.h"

#include <chrono>
#include <future>
#include <random>
#include <set>

#include "common/base/hash.h"
#include "common/base/timer.h"
#include "common/comm/broadcast_chain.h"
#include "common/comm/rest.h"
#include "common/config/job_reader.h"
#include "common/plan/forecast/memory.h"
#include "common/protocol/fingerprint.h"
#include "common/protocol/messages.h"
#include "common/scene/pack/scene_codec.h"
#include "worker/silence_watch.h"
#include "worker/tracer_pool.h"
#include "worker/work_prefetch.h"

namespace treefarm {

namespace {

/// Heartbeats without progress of a tree or scene, after which it is requested again.
constexpr double kPatienceHeartbeats = 5.0;

/// Heartbeats of silence after which the coordinator counts as lost.
constexpr double kSilentHeartbeats = 10.0;

/// Least interval of updates once the coordinator has no units left: finished ones are then sent at once.
constexpr double kLeastUpdateSeconds = 0.05;

/// Messages handled before the loop's other duties.
constexpr int kMostLooks = 256;

/// Limit of a reported failure's text in bytes.
constexpr std::size_t kMostFailureBytes = 4096;

template <class T>
bool ready(const std::future<T>& task) {
    return task.valid() && task.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::uint64_t draw_incarnation() {
    std::random_device device;  // identifies a process, affects no result
    return (static_cast<std::uint64_t>(device()) << 32 | device()) | 1;
}

class WorkerLoop {
  public:
    WorkerLoop(Channel& channel, const WorkerSettings& settings, const MakeRenderer& make_renderer, const Log& log)
        : channel_(channel),
          settings_(settings),
          make_renderer_(make_renderer),
          log_(log),
          chain_(channel),
          silence_(settings.silence_seconds),
          prefetch_(settings.threads) {}

    WorkerEnd run() {
        say_hello();
        while (!end_) {
            int looks = 0;  // a flood of messages must not starve the loop's other duties
            for (auto message = channel_.poll(); message;
                 message = ++looks < kMostLooks ? channel_.poll() : std::nullopt) {
                if (message->peer == 0)
                    take(message->bytes);
                else
                    take_from_worker(*message);
                if (end_) return *end_;
            }
            watch_for_leave();
            try {
                advance();
            } catch (const std::exception& error) {
                fail(error.what());
            }
            beat();
            if (!channel_.is_open(0)) {
                log_->error("the coordinator closed the connection: leaving");
                return WorkerEnd::orphaned;
            }
            if (silence_.too_long(clock_.seconds())) {
                log_->error("the coordinator has been silent for {:.0f} s: leaving", silence_.seconds());
                return WorkerEnd::orphaned;
            }
            rest(channel_, well_stocked());
        }
        return *end_;
    }

  private:
    template <class M>
    void tell(const M& message) {
        channel_.send(0, std::make_shared<const Bytes>(encode(message)));
    }

    void say_hello() {
        incarnation_ = draw_incarnation();
        tell(Hello{incarnation_, settings_.fingerprint, settings_.threads, job_number_, scene_hash_, settings_.memory,
                   settings_.host, kProgramVersion});
    }

    void take(const Bytes& bytes) {
        silence_.broken();
        try {
            std::visit(
                Overloads{[&](const Welcome& m) { on(m); },
                          [&](const Refuse& m) { log_->error("refused by the coordinator: {}", m.reason); },
                          [&](const Chunk& m) { chain_.take(m, clock_.seconds()); }, [&](const PassBegin& m) { on(m); },
                          [&](const Work& m) { on(m); }, [&](const Drop& m) { on(m); }, [&](const Heartbeat&) {},
                          [&](const Rejoin& m) { on(m); }, [&](const Quit&) { on_quit(); },
                          [&](const Leave& m) { end_ = m.finalize ? WorkerEnd::orderly : WorkerEnd::disorderly; },
                          [&](const auto&) { throw FormatError("a message that workers send, not receive"); }},
                decode(bytes));
        } catch (const std::exception& error) {
            fail(std::string("message from the coordinator: ") + error.what());
        }
    }

    /// Handles another worker's message: only pieces of scene and trees are accepted.
    void take_from_worker(const Received& received) {
        std::string wrong = "it sent a message that only the coordinator may send";
        try {
            const Message message = decode(received.bytes);
            if (const auto* chunk = std::get_if<Chunk>(&message)) {
                chain_.take(*chunk, clock_.seconds(), received.peer);
                return;
            }
        } catch (const std::exception& error) {
            wrong = error.what();
        }
        if (ignored_.insert(received.peer).second)
            log_->warn("messages of worker {} are ignored: {}", received.peer, wrong);
    }

    void on(const Welcome& m) {
        heartbeat_seconds_ = m.heartbeat_seconds;
        silence_.allow(kSilentHeartbeats * m.heartbeat_seconds);
        keep_scene_ = m.keep_scene;
        coming_scene_hash_ = m.scene_hash;
        coming_scene_bytes_ = m.scene_bytes;
        if (m.scene_hash != scene_hash_) chain_.expect(scene_name(), m.scene_bytes, clock_.seconds());
        if (m.job == job_text_ && m.scene_hash == scene_hash_) return;  // the renderer exists, or is being built
        job_ = Job{};
        apply_layer(job_, parse_job_settings(m.job, "job from the coordinator"));
        job_text_ = m.job;
        drop_work();  // the next renderer knows nothing of the present pass
        retire_pool();
        build_renderer_ = scene_ && m.scene_hash == scene_hash_;
    }

    void on(const PassBegin& m) {
        if (leaving_since_) return;
        coming_ = m;
        if (pass_ && pass_->plan().index != m.plan.index) end_pass();  // its remaining units are finished elsewhere
        chain_.expect({Blob::tree, job_number_, m.plan.index}, m.tree_bytes, clock_.seconds());
    }

    void on(const Work& m) {
        if (!pass_ || m.pass != pass_->plan().index || !pool_) return;  // of an earlier incarnation
        if (leaving_since_) return;                                     // returned by the good-bye
        prefetch_.receive(m.units.size(), m.units.empty() || m.alone);
        if (prefetch_.nothing_left() && clock_.seconds() - last_update_ > kLeastUpdateSeconds) send_bundle();
        pool_->add(m.units);
    }

    void on(const Drop& m) {
        if (pass_ && m.pass == pass_->plan().index && pool_) pool_->drop(m.units);
    }

    /// Drops all units, which the coordinator has issued again, or whose job has ended.
    void on(const Rejoin& m) {
        if (leaving_since_) return;
        drop_work();
        if (m.job == job_number_) {
            log_->warn("the coordinator thought this worker lost: joining again");
            chain_.restart(Blob::tree);
        } else {
            job_number_ = m.job;
            chain_.begin_job(m.job);
            coming_scene_hash_ = 0;
            if (failed_) {  // the job may have been the cause
                retire_pool();
                job_text_.clear();
                scene_hash_ = 0;
                failed_ = false;
            }
        }
        say_hello();
    }

    /// Retires the pool: its threads end after their present units.
    void retire_pool() {
        if (!pool_) return;
        pool_->cancel();
        retired_ = std::move(pool_);
    }

    void on_quit() {
        drop_work();
        quitting_ = true;
    }

    void drop_work() {
        end_pass();
        coming_.reset();
    }

    void end_pass() {
        if (pool_) pool_->cancel();
        pass_.reset();
    }

    /// Performs every action that needs no message.
    void advance() {
        chain_.complain(clock_.seconds(), kPatienceHeartbeats * heartbeat_seconds_);
        prepare_renderer();
        if (quitting_) {
            if (!said_bye_ && (!pool_ || pool_->idle())) {
                tell(Bye{incarnation_});
                said_bye_ = true;
            }
            return;
        }
        if (leaving_since_) return leave();
        if (failed_) return;
        if (pool_)
            if (const auto failure = pool_->failure()) throw RunError(*failure);
        prepare_pass();
        if (!pass_) return;
        send_finished();
        ask_for_work();
    }

    void watch_for_leave() {
        if (leaving_since_ || !settings_.told_to_leave || !settings_.told_to_leave()) return;
        log_->info("told to leave: finishing the units in progress, for at most {:.0f} s", job_.farm.leave_seconds);
        leaving_since_ = clock_.seconds();
        if (pool_) pool_->cancel();
        coming_.reset();
    }

    /// Sends the finished units after tracing, and says good-bye, which returns the others. Then waits to be dismissed
    /// (guests are at once) or killed: mpirun ends the whole job if one process ends before the others.
    void leave() {
        const bool is_late = clock_.seconds() - *leaving_since_ > job_.farm.leave_seconds;
        if (has_left_ || (pool_ && !pool_->idle() && !is_late)) return;
        if (pass_) send_bundle();
        drop_work();
        tell(Bye{incarnation_});
        has_left_ = true;
    }

    BlobName scene_name() const { return {Blob::scene, job_number_, 0}; }

    /// Whether a received blob has the announced hash; if not, requests it from the coordinator.
    bool is_what_was_announced(const BlobName& name, const Bytes& bytes, std::uint64_t hash, std::uint64_t total) {
        if (hash_bytes(bytes) == hash) return true;
        if (!chain_.mistrust(name, total, clock_.seconds()))
            throw FormatError(std::string(name.blob == Blob::tree ? "the tree" : "the scene") +
                              " arrived from the coordinator with a wrong hash");
        log_->warn("a {} was corrupted in transit: requesting it again", name.blob == Blob::tree ? "tree" : "scene");
        return false;
    }

    /// Builds the renderer in the background from scene and job, once the last one is gone; starts the threads.
    void prepare_renderer() {
        if (coming_scene_hash_ != 0) {  // 0: no Welcome yet
            auto scene = chain_.collect(scene_name());
            if (scene && is_what_was_announced(scene_name(), *scene, coming_scene_hash_, coming_scene_bytes_)) {
                scene_ = std::make_shared<const Bytes>(std::move(*scene));
                scene_hash_ = coming_scene_hash_;
                build_renderer_ = true;
            }
        }
        if (retired_ && retired_->idle()) retired_.reset();
        if (ready(renderer_task_)) {
            if (build_renderer_)
                renderer_task_ = {};  // of an earlier job
            else
                pool_ = std::make_unique<TracerPool>(settings_.threads, renderer_task_.get());
        }
        if (!build_renderer_ || renderer_task_.valid() || retired_) return;
        build_renderer_ = false;
        renderer_task_ = std::async(std::launch::async, [make = make_renderer_, bytes = scene_, job = job_] {
            Scene scene = decode_scene(*bytes);
            const Resolved resolved = resolve(job, scene);
            return make(std::move(scene), resolved);
        });
        if (!keep_scene_) scene_.reset();
    }

    /// Builds the guide in the background once the tree has arrived; once it is built, starts the pass.
    void prepare_pass() {
        if (coming_ && !pass_task_.valid()) {
            const BlobName name{Blob::tree, job_number_, coming_->plan.index};
            auto tree = chain_.collect(name);
            if (tree && is_what_was_announced(name, *tree, coming_->tree_hash, coming_->tree_bytes)) {
                pass_task_job_ = job_number_;
                pass_task_ = std::async(std::launch::async, [plan = coming_->plan, bytes = std::move(*tree),
                                                             filter = job_.guiding.directional_filter] {
                    return std::make_shared<PassWork>(plan, AnyModel::decode(bytes), filter);
                });
            }
        }
        if (!pool_ || !ready(pass_task_)) return;
        std::shared_ptr<PassWork> built = pass_task_.get();
        if (!coming_ || pass_task_job_ != job_number_ || built->plan().index != coming_->plan.index) return;
        result_seconds_ = coming_->result_seconds;
        coming_.reset();
        pass_ = std::move(built);
        prefetch_.begin();
        pool_->begin(pass_);
        last_update_ = clock_.seconds();
    }

    /// Sends finished units at intervals, and at the end of a pass. A briefly empty queue is not the end: more results
    /// leave the coordinator less time to hand out units.
    void send_finished() {
        const bool at_end = prefetch_.nothing_left() && pool_->idle(), enough = pass_->bundle_bytes() >= kBundleBytes;
        if (at_end || enough || clock_.seconds() - last_update_ >= result_seconds_) send_bundle();
    }

    void send_bundle() {
        last_update_ = clock_.seconds();
        if (auto result = pass_->close()) {
            result->incarnation = incarnation_;
            tell(*result);
        }
    }

    bool well_stocked() const {
        return pass_ && pool_ && prefetch_.is_well_stocked(pass_->plan(), job_.farm.tile_size, pool_->queued());
    }

    void ask_for_work() {
        const PassPlan& plan = pass_->plan();
        const auto more = prefetch_.request(plan, job_.farm.tile_size, pool_->queued());
        if (!more) return;
        const std::uint64_t paths_each = plan.units.tiles ? plan.unit_spp() : 1;
        tell(Want{incarnation_, plan.index, static_cast<std::uint32_t>(*more), paths_each * pool_->queued_weight()});
    }

    void beat() {
        const double now = clock_.seconds();
        if (now - last_beat_ < heartbeat_seconds_) return;
        last_beat_ = now;
        tell(Heartbeat{incarnation_, pool_ ? pool_->samples() : 0, pool_ ? pool_->rays() : 0});
    }

    /// Reports a failure to the coordinator once, then waits to be dismissed.
    void fail(const std::string& whole) {
        const std::string text = whole.substr(0, kMostFailureBytes);
        log_->error("{}", text);
        if (failed_) return;
        failed_ = true;
        drop_work();
        tell(Failure{incarnation_, text});
    }

    Channel& channel_;
    const WorkerSettings settings_;
    const MakeRenderer make_renderer_;
    const Log log_;
    ChainReceiver chain_;
    const Timer clock_;
    std::uint64_t incarnation_ = 0;
    Job job_;
    double heartbeat_seconds_ = 1.0;
    SilenceWatch silence_;
    double last_beat_ = 0, last_update_ = 0, result_seconds_ = 0;
    bool quitting_ = false, said_bye_ = false, failed_ = false, has_left_ = false;
    std::optional<double> leaving_since_;  ///< time of the order to leave
    std::optional<WorkerEnd> end_;
    std::set<int> ignored_;  ///< workers whose messages are ignored, reported once each

    std::uint32_t job_number_ = 0, pass_task_job_ = 0;  ///< of the renderer, and of the pass being built
    std::string job_text_;                              ///< of job_; empty: none yet
    std::shared_ptr<const Bytes> scene_;
    std::uint64_t scene_hash_ = 0, coming_scene_hash_ = 0, coming_scene_bytes_ = 0;
    bool keep_scene_ = false, build_renderer_ = false;  ///< scene and job are there, no renderer is built yet
    std::future<RenderUnit> renderer_task_;
    std::unique_ptr<TracerPool> pool_, retired_;
    std::optional<PassBegin> coming_;  ///< announced, its guide not built yet
    std::future<std::shared_ptr<PassWork>> pass_task_;
    std::shared_ptr<PassWork> pass_;
    Prefetch prefetch_;
};

}  // namespace

WorkerEnd run_worker(Channel& channel, const WorkerSettings& settings, const MakeRenderer& make_renderer,
                     const Log& log) {
    return WorkerLoop(channel, settings, make_renderer, log).run();
}

}  // namespace treefarm
