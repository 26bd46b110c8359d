// SPDX-License-Identifier: Apache-2.0
#include "coordinator/pass_loop.h"

#include <algorithm>
#include <future>

#include "common/base/hash.h"
#include "common/config/aov_list.h"
#include "common/film/fold_passes.h"
#include "common/film/guiding_probe.h"
#include "common/guiding/tree_learner.h"
#include "common/plan/kernel.h"
#include "common/plan/learning.h"

namespace treefarm {

namespace {

std::uint64_t hash_image(const CombinedImage& image) {
    static_assert(sizeof(Rgb64) == 3 * sizeof(double));
    return hash_bytes({reinterpret_cast<const std::uint8_t*>(image.mean.data()), image.mean.size() * sizeof(Rgb64)});
}

std::uint64_t hash_aovs(const std::vector<AovChannel>& channels) {
    std::vector<std::uint64_t> hashes;
    for (const AovChannel& channel : channels)
        hashes.push_back(hash_bytes(
            {reinterpret_cast<const std::uint8_t*>(channel.values.data()), channel.values.size() * sizeof(float)}));
    return hash_bytes({reinterpret_cast<const std::uint8_t*>(hashes.data()), hashes.size() * sizeof(std::uint64_t)});
}

class PassLoop {
  public:
    PassLoop(Farm& farm, const Resolved& job, const PassChooser& choose, SdTree tree, int width, int height,
             const PassHooks& hooks)
        : farm_(farm),
          job_(job),
          choose_(choose),
          hooks_(hooks),
          aovs_(aov_requests(job), static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        result_.width = width;
        result_.height = height;
        result_.tree = std::move(tree);
    }

    RenderResult run() {
        try {
            render_passes();
        } catch (...) {
            if (hooks_.on_failure) hooks_.on_failure(std::move(result_));
            throw;
        }
        return std::move(result_);
    }

  private:
    void render_passes() {
        for (NextPass next = choose_(state_); next.pass;) {
            const Timer timer;
            PassPlan plan = *next.pass;
            plan.kernel = kernel_of(job_, plan, facts_of(result_.tree));
            PassReport report;
            report.plan = plan;
            broadcast(plan, report);
            if (!collect(plan, next, report)) {
                result_.interrupted = true;
                if (hooks_.on_interruption) hooks_.on_interruption(result_);
                break;
            }
            keep(plan);
            farm_.beat_during([&] { combine(report); });
            next = look_ahead(report);
            farm_.beat_during([&] { learn(plan, next, report); });
            finish(report, timer.seconds());
        }
    }

    bool guided() const { return job_.guides; }

    void broadcast(const PassPlan& plan, PassReport& report) {
        result_.tree.pass = plan.index;  // also where the pass before taught nothing
        Bytes encoded = encode_tree(result_.tree);
        coming_tree_hash_ = hash_bytes(encoded);
        report.tree = tree_figures(result_.tree, encoded.size());
        farm_.begin_pass(plan, result_.tree, std::move(encoded), result_.width, result_.height);
    }

    /// Collects the results of a pass; false if it was interrupted.
    bool collect(const PassPlan& plan, const NextPass& chosen, PassReport& report) {
        const Timer timer;
        while (!farm_.pass_complete()) {
            if (hooks_.interrupted && hooks_.interrupted()) return false;
            farm_.step();
            tell_progress(plan, chosen);
        }
        if (plan.index == 0) loading_seconds_ = farm_.first_request_seconds();
        report.seconds.broadcast = farm_.broadcast_seconds();
        report.seconds.collect = std::max(0.0, timer.seconds() - report.seconds.broadcast);
        return true;
    }

    void keep(const PassPlan& plan) {
        const PassPlan* const before = result_.passes.empty() ? nullptr : &result_.passes.back().plan;
        PassResult pass = finished_pass(plan, before, farm_.take_pixels());
        if (const TraceStats stats = farm_.collector().totals(); stats.probe_paths > 0) {
            probe_.add(pass.pixels, stats, plan.index);
            // An image of one pass alone has nothing better for them.
            if (!shows_last_tree_only(job_)) set_aside_.take_out(pass.pixels, plan.index, finished_.size());
        }
        show(std::move(pass), job_, finished_);
        if (aovs_.requested()) aovs_.add(farm_.take_aovs(), plan.spp);
    }

    void combine(PassReport& report) {
        Timer timer;
        if (const std::optional<std::size_t> first = fold_passes(finished_)) set_aside_.follow_fold(*first);
        // The last pass's own figures, and those of the image, while others are being made.
        std::future<PassVariance> variance =
            std::async(std::launch::async, [&] { return pass_variance(finished_.back().pixels); });
        remember_noise(finished_, job_.guiding.combination, guided());
        coming_.image = std::make_shared<CombinedImage>(combine_passes(finished_, job_.guiding.combination, guided()));
        report.seconds.film = timer.seconds();
        timer.restart();
        fill_from_collector(report, farm_.collector());
        std::future<ErrorEstimate> error =
            std::async(std::launch::async, [&] { return estimate_error(*coming_.image, job_.sampler.seed); });
        std::future<std::uint64_t> hash = std::async(std::launch::async, [&] { return hash_image(*coming_.image); });
        find_gain(report);
        if (aovs_.requested())
            coming_.aovs = std::make_shared<std::vector<AovChannel>>(aovs_.channels(*coming_.image, finished_));
        coming_.image_hash = hash.get();
        report.variance = variance.get();
        state_.error = report.error = error.get();
        report.seconds.error = timer.seconds();
    }

    void find_gain(PassReport& report) const {
        if (report.plan.guided && report.plan.record)
            report.guiding_gain = probe_.gain(finished_.back().pixels, report.stats, report.plan.index,
                                              coming_.image->mean, static_cast<std::size_t>(result_.width));
    }

    /// Judges guiding by one image-wide number: a decision, not a weight, so no pixel is biased by its own samples.
    void judge_guiding(PassReport& report) {
        if (report.plan.guided && report.plan.record) {
            if (state_.guiding == Guiding::open)
                state_.guiding = treefarm::judge_guiding(report.plan, report.guiding_gain);
            if (state_.guiding == Guiding::loses) set_aside_.put_back(finished_);
        }
        report.guiding = state_.guiding;
    }

    void judge_splitting(PassReport& report) {
        report.splitting_gain = splitting_gain(report.stats);
        if (job_.guiding.splitting_rule == Rule::while_it_pays &&
            !splitting_may_pay(report.plan, report.splitting_gain))
            state_.splitting = false;
        report.splitting = state_.splitting;
    }

    NextPass look_ahead(PassReport& report) {
        judge_guiding(report);
        judge_splitting(report);
        const double before = state_.passes.empty() ? 0.0 : result_.passes.back().seconds.refine;
        const PassSeconds& s = report.seconds;
        const double loading = report.plan.index == 0 ? loading_seconds_ : 0.0;
        PassFacts facts;
        facts.spp = report.plan.spp;
        facts.spp_before = report.plan.first_sample;
        facts.mse_of_sample = report.variance.mse_of_sample;
        facts.stuv_trimmed = report.variance.stuv_trimmed;
        facts.collect_seconds = s.collect;
        facts.overhead_seconds = std::max(0.0, s.broadcast - loading) + s.film + s.error + before;
        facts.trace_core_seconds = report.stats.trace_seconds;
        facts.record_core_seconds = s.splat;
        facts.record = report.plan.record;
        facts.next_event = report.plan.next_event;
        state_.passes.push_back(facts);
        state_.seconds = report.run_seconds = clock_.seconds() - loading_seconds_;
        report.halving = forecast_error(state_, job_, 0.5 * report.error.relative());
        if (job_.budget.error > 0) report.target = forecast_error(state_, job_, job_.budget.error);
        return choose_(state_);
    }

    void learn(const PassPlan& plan, const NextPass& next_pass, PassReport& report) {
        if (!plan.record || !next_pass.pass) return;
        const Timer timer;
        coming_.tree = learner_.learn(result_.tree, farm_.collector().sums(),
                                      refine_settings(job_, plan, *next_pass.pass), plan.learn_mixture, report.refine);
        report.seconds.refine = timer.seconds();
    }

    void finish(PassReport& report, double seconds) {
        report.seconds.all = seconds;
        report.spp_done = report.plan.first_sample + report.plan.spp;
        report.workers = farm_.roster().present_count();
        report.threads = static_cast<std::uint32_t>(farm_.roster().thread_count());
        count_idle(report);
        // All at once: whatever fails before leaves the pass before, whole.
        result_.passes.push_back(report);
        result_.image = std::move(coming_.image);
        result_.image_hash = coming_.image_hash;
        if (coming_.aovs) {
            result_.aovs = std::move(coming_.aovs);
            result_.aov_hash = hash_aovs(*result_.aovs);
        }
        result_.spp = report.spp_done;
        result_.tree_hash = coming_tree_hash_;
        if (coming_.tree) result_.tree = std::move(*coming_.tree);
        coming_ = {};
        if (hooks_.on_pass) hooks_.on_pass(report, *result_.image);
        if (hooks_.on_result) hooks_.on_result(result_);
    }

    /// Reading in the scene, before the first pass, is not rendering.
    double run_seconds() const {
        if (!result_.passes.empty()) return clock_.seconds() - loading_seconds_;
        const double loading = farm_.first_request_seconds();
        return loading > 0 ? std::max(0.0, clock_.seconds() - loading) : 0.0;
    }

    void tell_progress(const PassPlan& plan, const NextPass& chosen) {
        if (!hooks_.on_progress) return;
        const Ledger& ledger = farm_.ledger();
        const double of_pass = static_cast<double>(ledger.done()) / static_cast<double>(ledger.total());
        RenderProgress progress;
        progress.pass = plan.index;
        progress.pass_count = chosen.pass_count;
        progress.spp_done = result_.spp;
        progress.spp_total = chosen.spp_total;
        if (chosen.spp_total > 0)
            progress.fraction = std::min(1.0, (plan.first_sample + of_pass * plan.spp) / chosen.spp_total);
        progress.error = state_.error;
        progress.workers = farm_.roster().present_count();
        progress.rays = farm_.rays_traced();
        progress.run_seconds = run_seconds();
        if (!result_.passes.empty()) {
            progress.target = result_.passes.back().target;
            progress.target_since = result_.passes.back().run_seconds;
        }
        hooks_.on_progress(progress);
    }

    Farm& farm_;
    const Resolved& job_;
    const PassChooser& choose_;
    const PassHooks& hooks_;
    TreeLearner learner_;
    RenderResult result_;
    std::vector<PassResult> finished_;  ///< folded
    AovSums aovs_;
    GuidingProbe probe_;
    ProbesSetAside set_aside_;
    std::uint64_t coming_tree_hash_ = 0;
    /// Image and tree of a pass that is being finished.
    struct {
        std::shared_ptr<const CombinedImage> image;
        std::shared_ptr<const std::vector<AovChannel>> aovs;
        std::uint64_t image_hash = 0;
        std::optional<SdTree> tree;  ///< that it taught
    } coming_;
    const Timer clock_;
    double loading_seconds_ = 0;  ///< until the first worker had scene and tree and asked for work
    RenderState state_;
};

}  // namespace

RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, SdTree tree, int width, int height,
                        const PassHooks& hooks) {
    return PassLoop(farm, job, choose, std::move(tree), width, height, hooks).run();
}

}  // namespace treefarm
