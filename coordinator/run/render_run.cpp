// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/render_run.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/hash.h"
#include "common/base/text/parse_text.h"
#include "common/plan/effects/plan_text.h"
#include "common/plan/schedule/learning.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/display/live_display.h"
#include "coordinator/farm/join_listener.h"
#include "coordinator/farm/memory_check.h"
#include "coordinator/input/lint/lint.h"
#include "coordinator/words/decision_text.h"
#include "coordinator/words/pass_text.h"
#include "coordinator/words/tail_report.h"

namespace treefarm {

namespace {

/// Later jobs of a study take the place of the first in the memory of all processes.
bool checks_memory(const RenderRequest& request) {
    // What goes on was checked when it began, and its films are in memory already.
    return request.job.farm.memory_check && request.turn.number <= 1 && !request.resumed;
}

FolderUse folder_use(const RenderRequest& request) {
    if (request.resumed) return FolderUse::resume;
    return request.overwrite ? FolderUse::replace : FolderUse::fresh;
}

/// A render that has found no light in so many passes says so before it ends.
constexpr std::uint32_t kPassesInTheDark = 3;

class RenderRun {
  public:
    RenderRun(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted)
        : request_(request),
          channel_(channel),
          interrupted_(interrupted),
          scene_(encode_scene(request.scene)),
          directory_(request.job,
                     {request.command, content_hash(scene_), request.fingerprint, request.plan.approximations,
                      request.scene.film.crop, request.schedule, request.life ? request.life->attempt() : ""},
                     request.plan, {folder_use(request), interrupted, request.resumed.get()}),
          log_(make_log("treefarm", directory_.log_file(), request.console, request.verbosity)),
          progress_(request.console, request.job.budget, request.status_frame),
          display_(request.display_server, "treefarm " + directory_.path().filename().string()),
          farm_(channel, request.plan.job, std::move(scene_), request.fingerprint.hash(), log_, {}, request.turn),
          spp_before_(request.resumed ? request.resumed->state.spp() : 0) {
        farm_.debug_by(request.debug_command, replay_options());
    }

    RenderOutcome run() {
        log_->debug("{}", request_.command);
        for (const std::string& warning : request_.warnings)
            log_->warn("{}", warning);
        for (const std::string& note : request_.notes)
            log_->info("{}", note);
        for (const Approximation& approximation : request_.plan.approximations)
            log_->warn("{}", approximation_text(approximation));
        RunEnd end;
        try {
            render();
            end.state = result_.interrupted ? RunState::interrupted : RunState::done;
        } catch (const InputError&) {
            progress_.clear();
            if (request_.resumed)
                leave(end);
            else
                directory_.give_back();
            throw;
        } catch (const std::bad_alloc&) {
            end.error = "not enough memory; render a smaller image, or on a machine that has more";
        } catch (const std::exception& failure) {
            end.error = failure.what();
        }
        progress_.clear();
        if (!end.error.empty()) log_->error("{}", end.error);
        finish(end);
        report(end);
        RenderOutcome outcome;
        outcome.state = end.state;
        outcome.missed_target = end.state == RunState::done && missed_target();
        outcome.lost_peers = farm_.lost_peers();
        outcome.left_peers = farm_.left_peers();
        return outcome;
    }

  private:
    /// Keeps what the finished passes gave, where that can still be written.
    void finish(RunEnd& end) {
        end.elapsed_seconds = clock_.seconds();
        enter(LifePhase::write);
        tell_news();
        if (request_.resumed && (!went_on_ || result_.spp < spp_before_)) return leave(end);
        for (const std::string& failure : directory_.finish(result_, &farm_, end))
            log_->error("{}", failure);
    }

    /// Leaves what the render went on with as it was.
    void leave(const RunEnd& end) { directory_.leave(end.state, spp_before_, end.elapsed_seconds); }

    /// Logs the news of files that could not be written, and of a viewer that shows nothing.
    void tell_news() {
        for (const std::string& news : display_.take_news())
            log_->warn("{}", news);
        for (const std::string& news : directory_.take_news()) {
            log_->warn("{}", news);
        }
    }

    void render() {
        const PassChooser passes = passes_of(request_);
        const Film& film = request_.scene.film;
        RenderState state = take_state();
        log_->info("{} {}, {}, {}; results in {}", request_.resumed ? "going on with" : "rendering", scene_name(),
                   size_text(film), budget_text(passes(state.history)), directory_.path().string());
        if (request_.resumed)
            log_->info("{} passes with {} spp are done{}, {} of rendering", state.reports.size(), state.spp(),
                       state.partial ? ", one is partly done" : "",
                       duration_text(state.partial ? state.partial->run_seconds : state.history.seconds));
        if (request_.resumed && job().farm.checkpoint_seconds == 0)
            log_->warn("no checkpoints (farm.checkpoint_seconds = 0): that of {} spp stays until the render is done",
                       state.spp());
        log_->debug("{} triangles", request_.scene.triangle_count());
        join_listener_.emplace(channel_, request_.job.farm, request_.fingerprint.hash(), directory_.path(), log_);
        enter(LifePhase::gather);
        farm_.gather(interrupted_);
        if (request_.resumed) {
            result_.interrupted = interrupted_();
            if (result_.interrupted) return;
            directory_.write_request();
            went_on_ = true;
        }
        farm_.allow_negative(film.is_signed());
        if (checks_memory(request_))
            check_memory(request_.plan.memory, this_host(), farm_.roster(), request_.job.scene.file);
        log_->debug("{} workers with {} threads", farm_.roster().present_count(), farm_.roster().thread_count());
        PassHooks hooks;
        hooks.interrupted = interrupted_;
        hooks.on_progress = [this, &film](const RenderProgress& progress) {
            const double elapsed = clock_.seconds();
            pass_count_ = progress.pass_count;
            progress_.update(progress);
            show_life(progress);
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
        if (request_.checkpoints) {
            hooks.state_due = [this] { return directory_.checkpoint_is_due(clock_.seconds()); };
            hooks.on_state = [this](RenderState& now) { directory_.offer_checkpoint(now, clock_.seconds()); };
            hooks.on_last_state = [this](RenderState last) { directory_.take_last_state(std::move(last)); };
        }
        hooks.on_failure = [this](RenderResult finished) { result_ = std::move(finished); };
        hooks.on_pass = [this](const PassReport& pass, const CombinedImage& image) {
            tell(pass);
            if (pass.plan.index >= kPassesInTheDark) tell_if_black(image, pass.spp_done);
            if (request_.on_pass) request_.on_pass(pass, image);
        };
        result_ = run_passes(farm_, job(), passes, std::move(state), film.width, film.height, hooks);
    }

    void enter(LifePhase phase) const {
        if (request_.life) request_.life->enter(phase);
    }

    /// For a supervisor: whether workers get on, and which are there.
    void show_life(const RenderProgress& progress) const {
        if (!request_.life) return;
        request_.life->see({progress.pass, directory_.passes(), farm_.ledger().done() + progress.rays});
        request_.life->see_workers([this] {
            std::vector<LifeWorker> workers;
            for (const auto& [peer, member] : farm_.roster().members())
                workers.push_back({member.hello.host, member.state == MemberState::lost});
            return workers;
        });
    }

    /// What the render begins with, or goes on from.
    RenderState take_state() const {
        if (request_.resumed) return std::move(request_.resumed->state);
        return starting_state(request_);
    }

    const Resolved& job() const { return request_.plan.job; }

    static std::string size_text(const Film& film) {
        std::string size = fmt::format("{} x {}", film.width, film.height);
        if (!film.crop.is_window()) return size;
        return fmt::format("{} at {},{} of {} x {}", size, film.crop.x, film.crop.y, film.whole_width(),
                           film.whole_height());
    }

    std::string budget_text(const NextPass& first) const {
        if (first.pass_count > 0) return fmt::format("{} spp in {} passes", first.spp_total, first.pass_count);
        const Job::Budget& budget = request_.job.budget;
        std::string text = budget.error > 0 ? fmt::format("until the error is {:.3g} %", 100 * budget.error) : "";
        if (budget.seconds > 0) text += fmt::format("{}{} s", text.empty() ? "for " : ", at most ", budget.seconds);
        if (budget.max_spp != Job::Budget{}.max_spp) text += fmt::format(", at most {} spp", budget.max_spp);
        return text;
    }

    std::string scene_name() const { return std::filesystem::path(request_.job.scene.file).stem().string(); }

    void tell(const PassReport& pass) {
        directory_.add_pass(pass);
        log_->info("{}", pass_line(pass, pass_count_));
        log_->debug("{}", pass_summary(pass, pass_count_));
        if (pass_count_ == 0 || pass.plan.index + 1 < pass_count_)
            for (const DecisionText& text : decision_texts(pass))
                log_->debug("from {} on: {}", pass_name(pass.plan.index + 1, 0), text.words);
        const std::string name = pass_name(pass.plan.index, 0);
        for (const InvalidSample& sample : pass.stats.first_invalid)
            log_->warn("radiance ({}, {}, {}) counts as black; reproduce with: {} {},{},{},{}{}", sample.rgb[0],
                       sample.rgb[1], sample.rgb[2], request_.debug_command, sample.pass, sample.x, sample.y,
                       sample.sample, replay_options());
        if (pass.stats.invalid_samples > pass.stats.first_invalid.size())
            log_->warn("{} invalid samples in {} in all", pass.stats.invalid_samples, name);
        if (pass.caps.capped_records > 0 || pass.caps.saturated_cells > 0 || pass.caps.outside_positions > 0)
            log_->warn("{}: {} records capped, {} cells saturated, {} positions outside the tree", name,
                       pass.caps.capped_records, pass.caps.saturated_cells, pass.caps.outside_positions);
        if (pass.splat_caps != SplatCaps{} || pass.saturated_splats > 0)
            log_->warn("{}: {} capped splats, {} saturated sums of splats, {} splats that are no radiance", name,
                       pass.splat_caps.capped, pass.saturated_splats, pass.splat_caps.rejected);
    }

    /// Says, once, what in the scene makes an image black.
    void tell_if_black(const CombinedImage& image, std::uint32_t spp) {
        const auto is_dark = [](const Rgb64& mean) { return mean == Rgb64(0.0); };
        if (reported_black_ || !std::all_of(image.mean.begin(), image.mean.end(), is_dark)) return;
        reported_black_ = true;
        const std::vector<Finding> causes = dark_causes(request_.scene);
        log_->warn(
            "the image is black after {} spp{}", spp,
            causes.empty() ? "; what in the scene makes it so is not plain to see: no path has met a light" : "");
        for (const Finding& cause : causes)
            log_->warn("{}", cause.text());
    }

    void report(const RunEnd& end) {
        if (directory_.has_previous())
            log_->warn("an earlier run's files lie aside in {}, until a run in this folder is done",
                       (directory_.path() / "previous*").string());
        if (end.state == RunState::failed) {
            if (const std::string kept = kept_text(); !kept.empty()) log_->info("{}", kept);
            return;
        }
        if (request_.resumed && !went_on_) {
            log_->warn("interrupted before it went on: nothing has changed");
            return;
        }
        if (result_.passes.empty()) {
            log_->warn("interrupted before the first pass was finished: there is no image{}",
                       kept_text().empty() ? "" : "; " + kept_text());
            return;
        }
        if (end.state == RunState::interrupted) log_->warn("interrupted: {}", kept_text());
        tell_if_black(*result_.image, result_.spp);
        const PassReport& last = result_.passes.back();
        log_->debug("{} spp in {:.2f} s, {}; image {} tree {}", result_.spp, end.elapsed_seconds,
                    error_text(last.error), hash_text(result_.image_hash), hash_text(result_.tree_hash));
        if (last.error.rmse > 0 && std::isfinite(last.halving.seconds))
            log_->info("half this error ({:.3g} %) would take {}{} more, {:.0f} spp", 100 * last.halving.relative_error,
                       trust_words(last.halving.trust), rough_duration_text(last.halving.seconds), last.halving.spp);
        if (const TailReport tails = tail_report(*result_.image, result_.passes); tails.stands_out)
            log_->info("{}", tail_text(tails, request_.debug_command, replay_options()));
        log_->info("{}", join_fields({fmt::format("{} spp", result_.spp), duration_text(last.run_seconds),
                                      brief_error_text(last.error), "image " + hash_text(result_.image_hash),
                                      image_file().string()}));
        if (missed_target())
            log_->warn("the error is above the {:.3g} % asked for: {}; the image is kept",
                       100 * request_.job.budget.error, why_missed());
    }

    /// What is kept of a render that is not done, and how it goes on.
    std::string kept_text() const {
        const bool goes_on = request_.checkpoints && request_.job.farm.checkpoint_seconds > 0;
        double share = 0;
        if (goes_on && farm_.has_pass())
            share = static_cast<double>(farm_.ledger().done()) / static_cast<double>(farm_.ledger().total());
        if (share == 1) share = 0;  // of a finished pass
        std::string text;
        if (result_.spp > 0) text = fmt::format("kept the {} spp of finished passes", result_.spp);
        if (share > 0)
            text += fmt::format("{}{:.0f} % of the unfinished pass", text.empty() ? "kept " : ", and ",
                                std::floor(100 * share));
        if (goes_on && !text.empty())
            text += "; go on with: treefarm resume " + shell_quoted(directory_.path().string());
        return text;
    }

    /// The image's file, where a person looks for it.
    std::filesystem::path image_file() const {
        const std::string& asked = request_.job.output.file;
        return asked.empty() ? directory_.path() / "image.exr" : std::filesystem::path(asked);
    }

    bool missed_target() const {
        return !result_.interrupted && !result_.passes.empty() && misses_target(job(), result_.passes.back().error);
    }

    std::string why_missed() const {
        const Job::Budget& budget = request_.job.budget;
        if (result_.spp >= budget.max_spp) return fmt::format("budget.max_spp = {} is reached", budget.max_spp);
        if (budget.seconds > 0) return fmt::format("the {} s are over", budget.seconds);
        return "the last pass was planned too short";
    }

    /// The options that make the passes known to --debug-sample, and the checkpoint.
    std::string replay_options() const {
        const std::filesystem::path run = std::filesystem::absolute(directory_.path());
        std::string options = " --run-dir " + shell_quoted(run.string());
        if (request_.schedule.empty()) options += " --schedule " + shell_quoted((run / "schedule.toml").string());
        return options;
    }

    const RenderRequest& request_;
    Channel& channel_;
    const std::function<bool()>& interrupted_;
    Bytes scene_;
    const Timer clock_;
    RunDirectory directory_;
    const Log log_;
    Progress progress_;
    LiveDisplay display_;
    Farm farm_;
    std::optional<JoinListener> join_listener_;
    bool reported_black_ = false;
    std::size_t pass_count_ = 0;      ///< 0: not known
    const std::uint32_t spp_before_;  ///< of what the render goes on with
    bool went_on_ = false;            ///< with that
    RenderResult result_;
};

}  // namespace

RenderState starting_state(const RenderRequest& request) {
    const Resolved& job = request.plan.job;
    return first_state(job, request.initial_model ? *request.initial_model : first_model(job, request.scene),
                       request.scene.film.pixel_count());
}

PassChooser passes_of(const RenderRequest& request) {
    if (!request.schedule.empty()) return listed_passes(request.schedule);
    return passes_of(request.plan.job, request.resumed ? request.resumed->state.plans() : std::vector<PassPlan>());
}

RenderOutcome run_render(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted) {
    // Before any file is touched: what this process alone takes. With the workers', once they have said what they have.
    if (checks_memory(request)) check_memory(request.plan.memory, this_host(), Roster(0), request.job.scene.file);
    return RenderRun(channel, request, interrupted).run();
}

}  // namespace treefarm
