// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render_state.h"

#include <cmath>
#include <future>
#include <utility>

#include "common/base/hash.h"
#include "common/config/aov_list.h"
#include "common/film/fold_passes.h"
#include "common/film/image_levels.h"
#include "common/plan/learning.h"
#include "common/plan/policy.h"

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

/// Judges guiding by one image-wide number: a decision, not a weight, so no pixel is biased by its own samples.
void judge_guiding(RenderState& state, const CombinedImage& image, std::size_t width, PassReport& report) {
    if (report.plan.guided && report.plan.record) {
        report.guiding_gain =
            state.probe.gain(state.films.back().pixels, report.stats, report.plan.index, image.mean, width);
        Guiding& verdict = state.history.guiding;
        if (verdict == Guiding::open) verdict = treefarm::judge_guiding(report.plan, report.guiding_gain);
        if (verdict == Guiding::loses) state.set_aside.put_back(state.films);
    }
    report.guiding = state.history.guiding;
}

void judge_splitting(RenderState& state, const Resolved& job, PassReport& report) {
    report.splitting_gain = splitting_gain(report.stats);
    if (job.guiding.splitting_rule == Rule::while_it_pays && !splitting_may_pay(report.plan, report.splitting_gain))
        state.history.splitting = false;
    report.splitting = state.history.splitting;
}

/// What the next pass is told of the image, and how often it samples emitters where nothing guides it.
void judge_next_event(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width,
                      PassReport& report) {
    if (!job.decides_next_event || !report.plan.next_event || !report.plan.layers.estimates) return;
    ImageLevels levels = image_levels(image.mean, width);
    const TraceStats& stats = report.stats;
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    const double ray_cost = report.plan.guided ? kPolicy.guiding.ray_cost : 1.0;
    const double rays = ray_cost * count(stats.rays) +
                        kPolicy.next_event.sample_cost * count(stats.next_event[kNextEventDrawn]) +
                        kPolicy.next_event.shadow_ray_cost * count(stats.shadow_rays);
    const double paths = count(stats.paths);
    report.price = {relative_variance(state.films.back().pixels, levels, width), paths > 0 ? rays / paths : 0, paths};
    ImageFacts facts{static_cast<std::uint32_t>(levels.columns), std::move(levels.inverse_levels),
                     state.tree.regions().image.next_event};
    if (!report.plan.guided)
        report.refine.next_event = state.image_next_event.learn(stats.next_event, report.price, facts.next_event);
    state.tree.set_image(std::move(facts));
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
    if (begun) plans.push_back(begun->plan);
    return plans;
}

void add_film(RenderState& state, const Resolved& job, CollectedPass pass) {
    const PassPlan* const before = state.reports.empty() ? nullptr : &state.reports.back().plan;
    PassResult result = finished_pass(pass.plan, before, std::move(pass.pixels));
    if (pass.stats.probe_paths > 0) {
        state.probe.add(result.pixels, pass.stats, pass.plan.index);
        // An image of one pass alone has nothing better for them.
        if (!shows_last_tree_only(job)) state.set_aside.take_out(result.pixels, pass.plan.index, state.films.size());
    }
    show(std::move(result), job, state.films);
    if (state.aovs.requested()) state.aovs.add(pass.aovs, pass.plan.spp);
    if (const std::optional<std::size_t> first = fold_passes(state.films)) state.set_aside.follow_fold(*first);
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
}

void judge(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width, PassReport& report) {
    judge_guiding(state, image, width, report);
    judge_splitting(state, job, report);
    judge_next_event(state, job, image, width, report);
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
