#include "coordinator/render_run.h"

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
          directory_(request.job, {request.command, hash_bytes(scene_), request.fingerprint}, request.plan),
          log_(make_log("treefarm", directory_.log_file(), request.quiet)),
          bar_(request.progress_bar),
          farm_(channel, request.job, std::move(scene_), request.fingerprint, log_) {}

    RenderOutcome run() {
        log_->debug("{}", request_.command);
        for (const std::string& warning : request_.warnings)
            log_->warn("{}", warning);
        for (const Approximation& approximation : request_.plan.approximations)
            log_->warn("{}", approximation_text(approximation));
        RenderOutcome outcome;
        std::string error;
        try {
            render();
            outcome.state = result_.interrupted ? RunState::interrupted : RunState::done;
            bar_.clear();
            directory_.write_image(result_);
        } catch (const InputError&) {
            throw;
        } catch (const std::bad_alloc&) {
            error = fail("not enough memory; render a smaller image, or on a machine that has more");
            outcome.state = RunState::failed;
        } catch (const std::exception& failure) {
            error = fail(failure.what());
            outcome.state = RunState::failed;
        }
        report(outcome.state, error);
        outcome.lost_peers = farm_.lost_peers();
        return outcome;
    }

  private:
    /// Keeps what the finished passes gave, where that can still be written.
    std::string fail(const std::string& error) {
        bar_.clear();
        log_->error("{}", error);
        try {
            directory_.write_image(result_);
            if (!result_.passes.empty()) log_->info("kept the {} spp of finished passes", result_.spp);
        } catch (const std::exception& again) {
            if (again.what() != error) log_->error("{}", again.what());
        }
        return error;
    }

    void render() {
        const std::vector<PassPlan> plans = plan_passes(request_.job);
        const Film& film = request_.scene.film;
        log_->info("{} x {} pixels, {} spp in {} passes, {} triangles; results in {}", film.width, film.height,
                   plans.back().first_sample + plans.back().spp, plans.size(), request_.scene.triangle_count(),
                   directory_.path().string());
        farm_.gather(interrupted_);
        log_->debug("{} workers with {} threads", farm_.roster().present_count(), farm_.roster().thread_count());
        PassHooks hooks;
        hooks.interrupted = interrupted_;
        hooks.on_progress = [this](const RenderProgress& progress) {
            const double elapsed = clock_.seconds();
            bar_.update(progress, elapsed);
            directory_.write_status(progress, elapsed);
        };
        hooks.on_failure = [this](RenderResult finished) { result_ = std::move(finished); };
        hooks.on_pass = [this, &plans](const PassReport& pass) { tell(pass, plans.size()); };
        result_ = run_passes(farm_, request_.job, plans, first_tree(request_.scene, request_.job), film.width,
                             film.height, hooks);
    }

    void tell(const PassReport& pass, std::size_t pass_count) {
        bar_.clear();
        directory_.add_pass(pass);
        log_->info("{}", pass_summary(pass, pass_count));
        for (const InvalidSample& sample : pass.stats.first_invalid)
            log_->warn("radiance ({}, {}, {}) counts as black; reproduce with: {} {},{},{},{}", sample.rgb[0],
                       sample.rgb[1], sample.rgb[2], request_.debug_command, sample.pass, sample.x, sample.y,
                       sample.sample);
        if (pass.stats.invalid_samples > pass.stats.first_invalid.size())
            log_->warn("{} invalid samples in pass {} in all", pass.stats.invalid_samples, pass.plan.index);
        if (pass.caps.capped_records > 0 || pass.caps.saturated_cells > 0 || pass.caps.outside_positions > 0)
            log_->warn("pass {}: {} records capped, {} cells saturated, {} positions outside the tree", pass.plan.index,
                       pass.caps.capped_records, pass.caps.saturated_cells, pass.caps.outside_positions);
    }

    void report(RunState state, const std::string& error) {
        const double elapsed = clock_.seconds();
        directory_.write_summary(state, result_, &farm_, elapsed, error);
        if (state == RunState::failed) return;
        if (result_.passes.empty()) {
            log_->warn("interrupted before the first pass was finished: there is no image");
            return;
        }
        if (state == RunState::interrupted) log_->warn("interrupted: kept the {} spp of finished passes", result_.spp);
        const double rmse = result_.passes.back().estimated_rmse;
        log_->info("{} spp in {:.2f} s, estimated rmse {:.4g}; image {} tree {}", result_.spp, elapsed, rmse,
                   hash_text(result_.image_hash), hash_text(result_.tree_hash));
        if (rmse > 0)
            log_->info("half this error would take about {:.0f} s more", 3 * elapsed);  // error ~ 1 / sqrt(time)
    }

    const RenderRequest& request_;
    const std::function<bool()>& interrupted_;
    Bytes scene_;
    const Timer clock_;
    RunDirectory directory_;
    const Log log_;
    ProgressBar bar_;
    Farm farm_;
    RenderResult result_;
};

}  // namespace

RenderOutcome run_render(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted) {
    return RenderRun(channel, request, interrupted).run();
}

}  // namespace treefarm
