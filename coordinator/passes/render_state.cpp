// SPDX-License-Identifier: Apache-2.0
#include "coordinator/passes/render_state.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <utility>

#include "common/base/hash.h"
#include "common/config/aov_list.h"
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

void judge(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width,
           const Decisions::Evidence& sums, PassReport& report) {
    JudgedPass pass{.plan = report.plan, .counts = report.stats, .rules = decision_rules(job)};
    pass.pixels = state.films.back().pixels;
    pass.width = width;
    pass.told = levels_of(state.tree.regions(), pass.pixels.size(), width);
    if (pass.measures_noise()) pass.levels = image_levels(image.mean, width);
    Decisions::judge(pass, sums, state.history.decisions, report.decisions);
    if (pass.measures_noise())
        state.tree.set_image({static_cast<std::uint32_t>(pass.levels.columns), std::move(pass.levels.inverse_levels),
                              state.history.decisions.get<NextEventDecision::Memory>().code});
}

void learn(RenderState& state, const Resolved& job, const PassPlan& pass, const std::optional<PassPlan>& coming,
           Blocks sums, PassReport& report) {
    if (!pass.record) return;
    const std::uint32_t done = pass.first_sample + pass.spp;
    const PassPlan next = coming ? *coming : make_pass(job, pass.index + 1, done, pass.spp, false);
    auto& next_event = report.decisions.get<NextEventDecision::Figures>();
    RefineSettings settings = refine_settings(job, pass, next);
    settings.next_event = next_event.price;
    ImageFacts image = state.tree.regions().image;
    state.tree = state.learner.learn(state.tree, std::move(sums), settings, pass.learn_mixture, report.refine);
    state.tree.set_image(std::move(image));
    state.last_tree = next.last_tree;
    next_event.verdict = report.refine.next_event;
}

}  // namespace treefarm
