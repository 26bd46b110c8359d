#include "coordinator/render_run.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "common/base/hash.h"
#include "common/plan/plan_text.h"
#include "common/scene/scene_codec.h"
#include "coordinator/progress.h"

namespace treefarm {

namespace {

class RenderRun {
  public:
    RenderRun(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted)
        : request_(request),
          interrupted_(interrupted),
          scene_(encode_scene(request.scene)),
          directory_(request.job,
                     {request.command, hash_bytes(scene_), request.fingerprint, request.plan.approximations},
                     request.plan, {request.overwrite, interrupted}),
          log_(make_log("treefarm", directory_.log_file(), request.quiet)),
          bar_(request.progress_bar),
          farm_(channel, request.job, std::move(scene_), request.fingerprint, log_, {}, request.turn) {}

    RenderOutcome run() {
        log_->debug("{}", request_.command);
        for (const std::string& warning : request_.warnings)
            log_->warn("{}", warning);
        for (const Approximation& approximation : request_.plan.approximations)
            log_->warn("{}", approximation_text(approximation));
        RunEnd end;
        try {
            render();
            end.state = result_.interrupted ? RunState::interrupted : RunState::done;
        } catch (const InputError& error) {
            end.error = error.what();
            finish(end);
            throw;
        } catch (const std::bad_alloc&) {
            end.error = "not enough memory; render a smaller image, or on a machine that has more";
        } catch (const std::exception& failure) {
            end.error = failure.what();
        }
        bar_.clear();
        if (!end.error.empty()) log_->error("{}", end.error);
        finish(end);
        report(end);
        RenderOutcome outcome;
        outcome.state = end.state;
        outcome.missed_target = end.state == RunState::done && missed_target();
        outcome.lost_peers = farm_.lost_peers();
        return outcome;
    }

  private:
    /// Keeps what the finished passes gave, where that can still be written.
    void finish(RunEnd& end) {
        end.elapsed_seconds = clock_.seconds();
        tell_news();
        for (const std::string& failure : directory_.finish(result_, &farm_, end))
            log_->error("{}", failure);
    }

    /// Of files that could not be written.
    void tell_news() {
        for (const std::string& news : directory_.take_news()) {
            bar_.clear();
            log_->warn("{}", news);
        }
    }

    void render() {
        const std::vector<PassPlan>& replayed = request_.schedule;
        const PassChooser passes = replayed.empty() ? passes_of(request_.job) : listed_passes(replayed);
        const Film& film = request_.scene.film;
        log_->info("{} x {} pixels, {}, {} triangles; results in {}", film.width, film.height, budget_text(passes({})),
                   request_.scene.triangle_count(), directory_.path().string());
        farm_.gather(interrupted_);
        log_->debug("{} workers with {} threads", farm_.roster().present_count(), farm_.roster().thread_count());
        PassHooks hooks;
        hooks.interrupted = interrupted_;
        hooks.on_progress = [this, &film](const RenderProgress& progress) {
            const double elapsed = clock_.seconds();
            pass_count_ = progress.pass_count;
            bar_.update(progress, elapsed);
            directory_.write_status(progress, elapsed);
            directory_.write_preview(farm_.collector().film().pixels(), film.width, film.height, elapsed);
            tell_news();
        };
        hooks.on_result = [this](const RenderResult& so_far) { directory_.write_image(so_far); };
        hooks.on_interruption = [this](const RenderResult& finished) {
            directory_.write_interruption(finished, &farm_, clock_.seconds());
        };
        hooks.on_failure = [this](RenderResult finished) { result_ = std::move(finished); };
        hooks.on_pass = [this](const PassReport& pass, const CombinedImage& image) {
            tell(pass);
            if (request_.on_pass) request_.on_pass(pass, image);
        };
        result_ = run_passes(farm_, request_.job, passes, first_tree(request_.scene, request_.job), film.width,
                             film.height, hooks);
    }

    std::string budget_text(const NextPass& first) const {
        if (first.pass_count > 0) return fmt::format("{} spp in {} passes", first.spp_total, first.pass_count);
        const Job::Budget& budget = request_.job.budget;
        std::string text = fmt::format("at most {} spp", budget.max_spp);
        if (budget.seconds > 0) text += fmt::format(", {} s", budget.seconds);
        if (budget.error > 0) text += fmt::format(", until the error is {:.3g} %", 100 * budget.error);
        return text;
    }

    void tell(const PassReport& pass) {
        bar_.clear();
        directory_.add_pass(pass);
        log_->info("{}", pass_summary(pass, pass_count_));
        for (const InvalidSample& sample : pass.stats.first_invalid)
            log_->warn("radiance ({}, {}, {}) counts as black; reproduce with: {} {},{},{},{}{}", sample.rgb[0],
                       sample.rgb[1], sample.rgb[2], request_.debug_command, sample.pass, sample.x, sample.y,
                       sample.sample, replay_option());
        if (pass.stats.invalid_samples > pass.stats.first_invalid.size())
            log_->warn("{} invalid samples in pass {} in all", pass.stats.invalid_samples, pass.plan.index);
        if (pass.caps.capped_records > 0 || pass.caps.saturated_cells > 0 || pass.caps.outside_positions > 0)
            log_->warn("pass {}: {} records capped, {} cells saturated, {} positions outside the tree", pass.plan.index,
                       pass.caps.capped_records, pass.caps.saturated_cells, pass.caps.outside_positions);
    }

    void report(const RunEnd& end) {
        if (directory_.has_previous())
            log_->warn("an earlier run's files lie aside in {}, until a run in this folder is done",
                       (directory_.path() / "previous*").string());
        if (end.state == RunState::failed) {
            if (!result_.passes.empty()) log_->info("the finished passes have {} spp", result_.spp);
            return;
        }
        if (result_.passes.empty()) {
            log_->warn("interrupted before the first pass was finished: there is no image");
            return;
        }
        if (end.state == RunState::interrupted)
            log_->warn("interrupted: kept the {} spp of finished passes", result_.spp);
        const PassReport& last = result_.passes.back();
        log_->info("{} spp in {:.2f} s, {}; image {} tree {}", result_.spp, end.elapsed_seconds, error_text(last.error),
                   hash_text(result_.image_hash), hash_text(result_.tree_hash));
        if (last.error.rmse > 0 && std::isfinite(last.halving.seconds))
            log_->info("half this error ({:.3g} %) would take {} more, {:.0f} spp", 100 * last.halving.relative_error,
                       forecast_text(last.halving), last.halving.spp);
        if (missed_target())
            log_->warn("the error is above the {:.3g} % asked for: {}; the image is kept",
                       100 * request_.job.budget.error, why_missed());
    }

    bool missed_target() const {
        return !result_.interrupted && !result_.passes.empty() &&
               misses_target(request_.job, result_.passes.back().error);
    }

    std::string why_missed() const {
        const Job::Budget& budget = request_.job.budget;
        if (result_.spp >= budget.max_spp) return fmt::format("budget.max_spp = {} is reached", budget.max_spp);
        if (budget.seconds > 0) return fmt::format("the {} s are over", budget.seconds);
        return "the last pass was planned too short";
    }

    /// What makes an open budget's passes known to --debug-sample.
    std::string replay_option() const {
        if (!request_.schedule.empty() || !has_open_budget(request_.job)) return "";
        return " --schedule " + std::filesystem::absolute(directory_.path() / "schedule.toml").string();
    }

    const RenderRequest& request_;
    const std::function<bool()>& interrupted_;
    Bytes scene_;
    const Timer clock_;
    RunDirectory directory_;
    const Log log_;
    ProgressBar bar_;
    Farm farm_;
    std::size_t pass_count_ = 0;  ///< 0: not known
    RenderResult result_;
};

}  // namespace

RenderOutcome run_render(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted) {
    return RenderRun(channel, request, interrupted).run();
}

}  // namespace treefarm
