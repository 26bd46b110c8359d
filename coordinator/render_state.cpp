// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render_state.h"

#include <cmath>
#include <future>
#include <utility>

#include "common/base/hash.h"
#include "common/config/aov_list.h"
#include "common/film/emission_shares.h"
#include "common/film/fold_passes.h"
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

void judge_light_subpaths(RenderState& state, const Resolved& job, PassReport& report) {
    report.light_subpath_gain = light_subpath_gain(report.stats);
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
    judge_light_subpaths(state, job, report);
}

void learn(RenderState& state, const Resolved& job, const PassPlan& pass, const std::optional<PassPlan>& coming,
           const CellSums& sums, RefineReport& report) {
    if (!pass.record) return;
    const std::uint32_t done = pass.first_sample + pass.spp;
    const PassPlan next = coming ? *coming : make_pass(job, pass.index + 1, done, pass.spp, false);
    state.tree = state.learner.learn(state.tree, sums, refine_settings(job, pass, next), pass.learn_mixture, report);
    state.last_tree = next.last_tree;
}

}  // namespace treefarm
