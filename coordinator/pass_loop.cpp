#include "coordinator/pass_loop.h"

#include <algorithm>
#include <cmath>

#include "common/base/hash.h"
#include "common/guiding/mixture.h"

namespace treefarm {

namespace {

std::uint64_t hash_image(const CombinedImage& image) {
    ByteWriter writer;
    for (const Rgb64& mean : image.mean)
        for (const double value : {mean.x, mean.y, mean.z})
            writer.put(value);
    return hash_bytes(writer.take());
}

class PassLoop {
  public:
    PassLoop(Farm& farm, const Job& job, std::span<const PassPlan> plans, SdTree tree, int width, int height,
             const PassHooks& hooks)
        : farm_(farm), job_(job), plans_(plans), hooks_(hooks) {
        result_.width = width;
        result_.height = height;
        result_.tree = std::move(tree);
    }

    RenderResult run() {
        try {
            render_passes();
        } catch (...) {
            result_.image_hash = hash_image(result_.image);
            if (hooks_.on_failure) hooks_.on_failure(std::move(result_));
            throw;
        }
        result_.image_hash = hash_image(result_.image);
        return std::move(result_);
    }

  private:
    void render_passes() {
        for (const PassPlan& plan : plans_) {
            const Timer timer;
            PassReport report;
            report.plan = plan;
            broadcast(plan, report);
            if (!collect(plan)) {
                result_.interrupted = true;
                break;
            }
            keep(plan);
            combine(report);
            learn(plan, report);
            finish(report, timer.seconds());
        }
    }

    bool guided() const { return job_.guiding.type != GuidingType::none; }

    void broadcast(const PassPlan& plan, PassReport& report) {
        Bytes encoded = encode_tree(result_.tree);
        coming_tree_hash_ = hash_bytes(encoded);
        report.tree = tree_figures(result_.tree, encoded.size());
        farm_.begin_pass(plan, result_.tree, std::move(encoded), result_.width, result_.height);
    }

    /// False if the pass was interrupted.
    bool collect(const PassPlan& plan) {
        while (!farm_.pass_complete()) {
            if (hooks_.interrupted && hooks_.interrupted()) return false;
            farm_.step();
            tell_progress(plan);
        }
        return true;
    }

    void keep(const PassPlan& plan) {
        if (guided() && job_.guiding.combination == Combination::last) finished_.clear();
        finished_.push_back({plan.spp, plan.first_sample, farm_.collector().film().pixels()});
        result_.spp = plan.first_sample + plan.spp;
        result_.tree_hash = coming_tree_hash_;
    }

    void combine(PassReport& report) {
        const Timer timer;
        result_.image = combine_passes(finished_, job_.guiding.combination, guided());
        estimated_rmse_ = report.estimated_rmse = estimated_rmse(result_.image);
        report.seconds.film = timer.seconds();
        farm_.beat();
    }

    void learn(const PassPlan& plan, PassReport& report) {
        if (!plan.record || plan.index + 1 >= plans_.size()) return;
        const Timer timer;
        RefineSettings settings;
        settings.spatial_threshold = spatial_split_threshold(job_, plans_[plan.index + 1]);
        settings.directional_divisor =
            static_cast<std::uint32_t>(std::lround(1.0 / static_cast<double>(job_.guiding.directional_threshold)));
        settings.record_weight = plan.record_weight;
        settings.target = job_.guiding.target;
        const TreeSums& sums = farm_.collector().sums();
        SdTree next = refine(result_.tree, sums, settings, report.refine);
        if (plan.learn_mixture) mixture_.learn(result_.tree, sums, report.refine.origins, next);
        next.pass = plan.index + 1;
        result_.tree = std::move(next);
        report.seconds.refine = timer.seconds();
        farm_.beat();
    }

    void finish(PassReport& report, double seconds) {
        report.seconds.all = seconds;
        report.seconds.broadcast = farm_.broadcast_seconds();
        report.spp_done = result_.spp;
        report.workers = farm_.roster().present_count();
        report.threads = farm_.roster().thread_count();
        fill_from_collector(report, farm_.collector());
        result_.passes.push_back(report);
        if (hooks_.on_pass) hooks_.on_pass(report);
    }

    void tell_progress(const PassPlan& plan) {
        if (!hooks_.on_progress) return;
        const PassPlan& last = plans_.back();
        const Ledger& ledger = farm_.ledger();
        const double of_pass = static_cast<double>(ledger.done()) / static_cast<double>(ledger.total());
        RenderProgress progress;
        progress.pass = plan.index;
        progress.pass_count = plans_.size();
        progress.spp_done = result_.spp;
        progress.spp_total = last.first_sample + last.spp;
        progress.fraction = (plan.first_sample + of_pass * plan.spp) / progress.spp_total;
        progress.estimated_rmse = estimated_rmse_;
        progress.workers = farm_.roster().present_count();
        progress.rays = farm_.rays_traced();
        hooks_.on_progress(progress);
    }

    Farm& farm_;
    const Job& job_;
    std::span<const PassPlan> plans_;
    const PassHooks& hooks_;
    MixtureLearner mixture_;
    RenderResult result_;
    std::vector<PassResult> finished_;
    std::uint64_t coming_tree_hash_ = 0;
    double estimated_rmse_ = 0;
};

}  // namespace

SdTree first_tree(const Scene& scene, const Job& job) {
    Box3 bounds = scene.bounds();
    bounds.extendBy(scene.camera.origin);
    const float scale = scene.radiance_scale();
    return initial_tree(bounds, job.guiding.target == GuidingTarget::variance ? scale * scale : scale,
                        job.guiding.bsdf_fraction);
}

RenderResult run_passes(Farm& farm, const Job& job, std::span<const PassPlan> passes, SdTree tree, int width,
                        int height, const PassHooks& hooks) {
    return PassLoop(farm, job, passes, std::move(tree), width, height, hooks).run();
}

}  // namespace treefarm
