// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/render.h"

#include <optional>
#include <utility>

#include "common/plan/schedule/learning.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/display/live_display.h"
#include "coordinator/farm/join_listener.h"
#include "coordinator/farm/memory_check.h"
#include "coordinator/render/render_log.h"
#include "coordinator/render/retrace_films.h"
#include "coordinator/run/run_directory.h"

namespace treefarm {

namespace {

/// Whether memory is checked: not for later jobs of a study, which reuse the memory of the first.
bool checks_memory(const RenderRequest& request) {
    // A resumed render was checked when it began, and its films are in memory already.
    return request.content.job.farm.memory_check && request.workers.turn.number <= 1 && !request.start.checkpoint;
}

FolderUse folder_use(const RenderRequest& request) {
    if (request.start.checkpoint) return FolderUse::resume;
    return request.storage.overwrite ? FolderUse::replace : FolderUse::fresh;
}

class RenderRun {
  public:
    RenderRun(Channel& channel, const RenderRequest& request, const RenderObserver& observer)
        : request_(request),
          observer_(observer),
          channel_(channel),
          interrupted_(request.workers.stop),
          scene_(encode_scene(request.content.scene)),
          directory_(request.content.job,
                     {request.origin.command, content_hash(scene_), request.origin.fingerprint,
                      request.content.plan.approximations, request.content.scene.film.crop, request.content.schedule,
                      request.origin.attempt},
                     request.content.plan, {folder_use(request), interrupted_, request.start.checkpoint.get()}),
          words_(request, directory_.path(), observer.message),
          log_(words_.log()),
          display_(request.storage.display_server, "treefarm " + directory_.path().filename().string()),
          farm_(channel, request.content.plan.job, std::move(scene_), request.origin.fingerprint.hash(), log_, {},
                request.workers.turn),
          spp_before_(request.start.checkpoint ? request.start.checkpoint->state.spp() : 0) {
        farm_.debug_by(request.origin.debug_command, words_.replay_options());
    }

    RenderOutcome run() {
        words_.tell_origin();
        RunEnd end;
        try {
            render();
            end.state = result_.interrupted ? RunState::interrupted : RunState::done;
        } catch (const InputError&) {
            if (request_.start.checkpoint)
                leave(end);
            else
                directory_.give_back();
            throw;
        } catch (const NoWorkerLeft& failure) {
            // A signal to mpirun may end the workers first. treefarm launch starts again after a failure.
            const bool stopped = failure.was_stopped() && request_.origin.attempt.empty();
            result_.interrupted = interrupted_() || stopped;
            if (result_.interrupted)
                end.state = RunState::interrupted;
            else
                end.error = failure.what();
            if (stopped) log_->warn("{}", failure.what());
        } catch (const std::bad_alloc&) {
            end.error = "not enough memory; render a smaller image, or on a machine that has more";
        } catch (const std::exception& failure) {
            end.error = failure.what();
        }
        enter(LifePhase::write);
        if (!end.error.empty()) log_->error("{}", end.error);
        finish(end);
        words_.tell_end(end, result_, !request_.start.checkpoint || went_on_, part_of_pass(),
                        directory_.has_previous());
        return outcome(end);
    }

  private:
    /// Saves the results of the finished passes, if that is still possible.
    void finish(RunEnd& end) {
        end.elapsed_seconds = clock_.seconds();
        tell_news();
        if (request_.start.checkpoint && (!went_on_ || result_.spp < spp_before_)) return leave(end);
        std::vector<std::string> failures;  // workers that hear nothing for half a minute would leave, and end the job
        farm_.beat_during([&] { failures = directory_.finish(result_, &farm_, end); });
        for (const std::string& failure : failures)
            log_->error("{}", failure);
    }

    /// Leaves the files of the resumed run as they were.
    void leave(const RunEnd& end) { directory_.leave(end.state, spp_before_, end.elapsed_seconds); }

    /// Logs errors of files that could not be written, and of the viewer.
    void tell_news() {
        for (const std::string& news : display_.take_news())
            log_->warn("{}", news);
        for (const std::string& news : directory_.take_news()) {
            log_->warn("{}", news);
        }
    }

    void render() {
        const PassChooser passes = passes_of(request_);
        const Film& film = request_.content.scene.film;
        RenderState state = take_state();
        words_.tell_start(state, passes(state.history));
        join_listener_.emplace(channel_, request_.content.job.farm, request_.origin.fingerprint.hash(),
                               directory_.path(), log_);
        enter(LifePhase::gather);
        if (checks_memory(request_)) farm_.require_of_guests(still_to_come(request_.content.plan.memory.worker));
        farm_.gather(interrupted_);
        farm_.allow_negative(film.is_signed());
        if (request_.start.checkpoint) {
            result_.interrupted = interrupted_() || !complete(state);
            if (result_.interrupted) return;
            directory_.write_request();
            went_on_ = true;
        }
        if (checks_memory(request_))
            check_memory(request_.content.plan.memory, this_host(), farm_.roster(), request_.content.job.scene.file);
        log_->debug("{} workers with {} threads", farm_.roster().present_count(), farm_.roster().thread_count());
        PassHooks hooks;
        hooks.interrupted = interrupted_;
        hooks.on_progress = [this, &film](const RenderProgress& progress) {
            const double elapsed = clock_.seconds();
            pass_count_ = progress.pass_count;
            if (observer_.progress) observer_.progress(progress, farm_.roster());
            directory_.write_status(progress, elapsed, &farm_);
            const auto pixels = farm_.collector().pixels_so_far();
            directory_.write_preview(pixels, film.width, film.height, elapsed);
            display_.show(pixels, film.width, film.height, elapsed);
            tell_news();
        };
        hooks.on_collected = [this] { enter(LifePhase::combine); };
        hooks.on_result = [this](const RenderResult& so_far) {
            directory_.write_image(so_far);
            display_.show(so_far);
        };
        hooks.on_interruption = [this](const RenderResult& finished) {
            directory_.write_interruption(finished, &farm_, clock_.seconds());
        };
        if (request_.storage.checkpoints) {
            hooks.state_due = [this] { return directory_.checkpoint_is_due(clock_.seconds()); };
            hooks.on_state = [this](RenderState& now) { directory_.offer_checkpoint(now, clock_.seconds()); };
            hooks.on_last_state = [this](RenderState last) { directory_.take_last_state(std::move(last)); };
        }
        hooks.on_failure = [this](RenderResult finished) { result_ = std::move(finished); };
        hooks.on_pass = [this](const PassReport& pass, const CombinedImage& image) {
            directory_.add_pass(pass);
            words_.tell_pass(pass, image, pass_count_);
            if (observer_.pass) observer_.pass(pass, image);
        };
        result_ = run_passes(farm_, job(), passes, std::move(state), film.width, film.height, hooks);
    }

    /// Completes the resumed state, if films of it were lost; false: interrupted.
    bool complete(RenderState& state) {
        PassHooks hooks;
        hooks.interrupted = interrupted_;
        hooks.on_progress = [this](const RenderProgress& progress) {
            if (observer_.progress) observer_.progress(progress, farm_.roster());
            tell_news();
        };
        return retrace_films(farm_, request_, state, hooks);
    }

    void enter(LifePhase phase) const {
        if (observer_.phase) observer_.phase(phase);
    }

    /// Finished fraction of the last pass.
    double part_of_pass() const {
        if (!farm_.has_pass()) return 0;
        return static_cast<double>(farm_.ledger().done()) / static_cast<double>(farm_.ledger().total());
    }

    RenderOutcome outcome(const RunEnd& end) {
        RenderOutcome outcome;
        outcome.state = end.state;
        outcome.error = end.error;
        outcome.missed_target = end.state == RunState::done && missed_target(request_, result_);
        outcome.folder = directory_.path();
        outcome.resumable = has_checkpoint_file(outcome.folder);
        outcome.lost_peers = farm_.lost_peers();
        outcome.left_peers = farm_.left_peers();
        outcome.result = std::move(result_);
        return outcome;
    }

    /// Initial or resumed state of the render.
    RenderState take_state() const {
        if (request_.start.checkpoint) return std::move(request_.start.checkpoint->state);
        return starting_state(request_);
    }

    const Resolved& job() const { return request_.content.plan.job; }

    const RenderRequest& request_;
    const RenderObserver& observer_;
    Channel& channel_;
    const std::function<bool()>& interrupted_;
    Bytes scene_;
    const Timer clock_;
    RunDirectory directory_;
    RenderLog words_;
    const Log log_;
    LiveDisplay display_;
    Farm farm_;
    std::optional<JoinListener> join_listener_;
    std::size_t pass_count_ = 0;      ///< 0: not known
    const std::uint32_t spp_before_;  ///< of the resumed run
    bool went_on_ = false;            ///< it has resumed that run
    RenderResult result_;
};

}  // namespace

RenderState starting_state(const RenderRequest& request) {
    const Resolved& job = request.content.plan.job;
    return first_state(job, request.start.model ? *request.start.model : first_model(job, request.content.scene),
                       request.content.scene.film.pixel_count());
}

PassChooser passes_of(const RenderRequest& request) {
    if (!request.content.schedule.empty()) return listed_passes(request.content.schedule);
    return passes_of(request.content.plan.job,
                     request.start.checkpoint ? request.start.checkpoint->plans : std::vector<PassPlan>());
}

RenderOutcome render(const RenderRequest& request, const RenderObserver& observer) {
    // Before any file is touched: memory of this process alone. That of the workers follows once they have reported.
    if (checks_memory(request))
        check_memory(request.content.plan.memory, this_host(), Roster(0), request.content.job.scene.file);
    if (!request.workers.channel && !request.workers.local) throw RunError("the render has no workers");
    std::optional<LocalFarm> here;
    if (!request.workers.channel) here.emplace(request.workers.local);
    RenderOutcome outcome = RenderRun(here ? here->channel() : *request.workers.channel, request, observer).run();
    if (observer.end) observer.end(outcome);
    return outcome;
}

}  // namespace treefarm
