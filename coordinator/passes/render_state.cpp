// SPDX-License-Identifier: Apache-2.0
#include "coordinator/passes/render_state.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <utility>

#include "common/base/hash.h"
#include "common/base/policy.h"
#include "common/config/aov_list.h"
#include "common/decide/emission/emission_shares.h"
#include "common/decide/light_subpaths/light_subpath_gain.h"
#include "common/decide/pixels/image_levels.h"
#include "common/film/fold_passes.h"
#include "common/plan/schedule/learning.h"

namespace treefarm {

namespace {

std::uint64_t hash_image(const CombinedImage& image) {
    static_assert(sizeof(Rgb64) == 3 * sizeof(double));
    return hash_bytes({reinterpret_cast<const std::uint8_t*>(image.mean.data()), image.mean.size() * sizeof(Rgb64)});
}

std::uint64_t hash_aovs(const std::vector<AovChannel>& channels) {
    std::vector<std::uint64_t> hashes;
    hashes.reserve(channels.size());
    for (const AovChannel& channel : channels)
        hashes.push_back(hash_bytes(
            {reinterpret_cast<const std::uint8_t*>(channel.values.data()), channel.values.size() * sizeof(float)}));
    return hash_bytes({reinterpret_cast<const std::uint8_t*>(hashes.data()), hashes.size() * sizeof(std::uint64_t)});
}

/// Light levels stored in the model; none if they are of another image, as in a damaged checkpoint.
ImageLevels levels_of(const RegionModel& model, std::size_t pixels, std::size_t width) {
    ImageLevels levels{model.image.columns, model.image.inverse_levels};
    return levels.fits(pixels, width) ? levels : ImageLevels();
}

/// Judges guiding by one number for the whole image: a decision, not a weight, so that no pixel is biased by its own
/// samples.
void judge_guiding(RenderState& state, const Resolved& job, std::size_t width, double cost, PassReport& report) {
    Guiding& verdict = state.history.guiding;
    GuidingMemory& memory = state.guiding_memory;
    const PassPlan& pass = report.plan;
    if (job.guiding.rule == Rule::while_it_pays && pass.layers.estimates && (!pass.guided || pass.record)) {
        const std::span<const PixelEstimate> pixels = state.films.back().pixels;
        const ImageLevels levels = levels_of(state.tree.regions(), pixels.size(), width);
        const GuidingVerdict judged =
            pass.guided
                ? memory.after_guided(pass, guiding_evidence(report.stats.unguided, pixels, levels, width, cost))
                : memory.after_unguided(pass, mean_variance(pixels, levels, width), verdict);
        verdict = judged.guiding;
        report.guiding_efficiency = judged.efficiency;
    }
    report.guiding = verdict;
}

void judge_splitting(RenderState& state, const Resolved& job, PassReport& report) {
    report.splitting_gain = splitting_gain(report.stats.splitting, report.stats);
    if (job.guiding.splitting_rule == Rule::while_it_pays && !splitting_may_pay(report.plan, report.splitting_gain))
        state.history.splitting = false;
    report.splitting = state.history.splitting;
}

/// Cost of a camera sample in closest-hit rays of unguided paths; of next event only the shadow rays count.
double sample_cost(const PassReport& report) {
    const TraceStats& stats = report.stats;
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    if (stats.paths == 0) return 0;
    const double rays = (report.plan.guided ? tuned("guiding.ray_cost") : 1.0) * count(stats.rays) +
                        tuned("next_event.shadow_ray_cost") * count(stats.shadow_rays);
    return rays / count(stats.paths);
}

/// Sets the light levels for the next pass, and its rate of emitter sampling if it is unguided.
void judge_next_event(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width,
                      double cost, PassReport& report) {
    if (!job.decides_next_event && job.guiding.rule != Rule::while_it_pays) return;
    if (!report.plan.layers.estimates) return;
    ImageLevels levels = image_levels(image.mean, width);
    const PassPlan& plan = report.plan;
    const auto asked = static_cast<double>(report.stats.next_event[kNextEventAsked]),
               drawn = static_cast<double>(report.stats.next_event[kNextEventDrawn]);
    // Samples along which direct light was counted.
    const std::uint64_t samples =
        multiples_in(plan.first_sample, plan.spp, tuned<std::uint32_t>("next_event.counted_every"));
    const double paths =
        asked > 0 ? static_cast<double>(report.stats.paths) * static_cast<double>(samples) / plan.spp : 0;
    report.price = {relative_variance(state.films.back().pixels, levels, width),
                    paths > 0 ? cost + tuned("next_event.sample_cost") * drawn / paths : 0, paths};
    ImageFacts facts{static_cast<std::uint32_t>(levels.columns), std::move(levels.inverse_levels),
                     state.tree.regions().image.next_event};
    if (job.decides_next_event && !plan.guided)
        report.refine.next_event =
            state.image_next_event.learn(report.stats.next_event, report.price, facts.next_event);
    else if (job.decides_next_event && asked > 0 && state.history.guiding == Guiding::loses)
        facts.next_event = next_event_code(drawn / asked);  // the efficiency was judged at the regions' own rates
    state.tree.set_image(std::move(facts));
}

/// Gain by light subpaths in all passes that had them, if this one has: most of the gain is rare light that few samples
/// find, and a single pass may have found it by one method only.
LightSubpathGain gain_so_far(const RenderState& state, const PassReport& report) {
    if (!report.plan.light_subpaths) return {};
    TraceStats all;
    const auto add = [&all](const PassReport& r) {
        if (!r.plan.light_subpaths) return;
        all.light_subpaths.add(r.stats.light_subpaths);
        all.rays += r.stats.rays;
        all.shadow_rays += r.stats.shadow_rays;
    };
    for (const PassReport& before : state.reports)
        add(before);
    add(report);
    return light_subpath_gain(all.light_subpaths, all);
}

void judge_light_subpaths(RenderState& state, const Resolved& job, PassReport& report) {
    report.light_subpath_gain = gain_so_far(state, report);
    if (job.bidirectional.light_subpaths == Rule::while_it_pays &&
        !light_subpaths_may_pay(report.plan, report.light_subpath_gain))
        state.history.light_subpaths = false;
    report.light_subpaths = state.history.light_subpaths;
    EmissionSums& emission = report.stats.emission;
    state.history.emission.add(emission);
    report.emitters = emission.paths.size();
    report.emitters_of_half = emitters_of_half(emission);
    emission = {};
}

}  // namespace

RenderState first_state(const Resolved& job, AnyModel tree, std::size_t pixels) {
    RenderState state;
    state.aovs = AovSums(aov_requests(job), pixels);
    state.tree = std::move(tree);
    return state;
}

std::vector<PassPlan> RenderState::plans() const {
    std::vector<PassPlan> plans;
    for (const PassReport& report : reports)
        plans.push_back(report.plan);
    if (partial) plans.push_back(partial->plan);
    return plans;
}

void add_film(RenderState& state, const Resolved& job, CollectedPass pass) {
    const PassPlan* const before = state.reports.empty() ? nullptr : &state.reports.back().plan;
    PassResult result = finished_pass(pass.plan, before, std::move(pass.pixels));
    show(std::move(result), job, state.films);
    if (state.aovs.requested()) state.aovs.add(pass.aovs, pass.plan.spp);
    fold_passes(state.films);
}

void combine_films(RenderState& state, const Resolved& job, DevelopedState& developed) {
    remember_noise(state.films, job.guiding.combination, job.guides);
    developed.image = std::make_shared<CombinedImage>(combine_passes(state.films, job.guiding.combination, job.guides));
}

void describe_image(const RenderState& state, const Resolved& job, DevelopedState& developed, PassVariance& last_pass) {
    const CombinedImage& image = *developed.image;
    std::future<PassVariance> variance =
        std::async(std::launch::async, [&] { return pass_variance(state.films.back().pixels); });
    std::future<ErrorEstimate> error =
        std::async(std::launch::async, [&] { return estimate_error(image, job.sampler.seed); });
    std::future<std::uint64_t> hash = std::async(std::launch::async, [&] { return hash_image(image); });
    if (state.aovs.requested()) {
        developed.aovs = std::make_shared<std::vector<AovChannel>>(state.aovs.channels(image, state.films));
        developed.aov_hash = hash_aovs(*developed.aovs);
    }
    developed.image_hash = hash.get();
    last_pass = variance.get();
    developed.error = error.get();
    require_finite(image, developed.error);
}

void require_finite(const CombinedImage& image, const ErrorEstimate& error) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const bool fits = std::all_of(image.mean.begin(), image.mean.end(), [](const Rgb64& v) {
        return std::abs(v.x) <= kMost && std::abs(v.y) <= kMost && std::abs(v.z) <= kMost;
    });
    if (!fits || !std::isfinite(error.rmse) || !std::isfinite(error.high))
        throw RunError(
            "the image or its error is not finite: some result or checkpoint was wrong; render again, into another "
            "run directory");
}

void judge(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width, PassReport& report) {
    const double cost = sample_cost(report);
    judge_guiding(state, job, width, cost, report);
    judge_splitting(state, job, report);
    judge_next_event(state, job, image, width, cost, report);
    judge_light_subpaths(state, job, report);
}

void learn(RenderState& state, const Resolved& job, const PassPlan& pass, const std::optional<PassPlan>& coming,
           const CellSums& sums, const NextEventPrice& price, RefineReport& report) {
    if (!pass.record) return;
    const std::uint32_t done = pass.first_sample + pass.spp;
    const PassPlan next = coming ? *coming : make_pass(job, pass.index + 1, done, pass.spp, false);
    RefineSettings settings = refine_settings(job, pass, next);
    settings.next_event = price;
    ImageFacts image = state.tree.regions().image;
    state.tree = state.learner.learn(state.tree, sums, settings, pass.learn_mixture, report);
    state.tree.set_image(std::move(image));
    state.last_tree = next.last_tree;
}

}  // namespace treefarm
