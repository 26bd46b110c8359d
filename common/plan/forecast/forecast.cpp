// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/policy.h"
#include "common/film/combine.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Limit of a forecast, in doublings of samples.
constexpr int kMostTrees = 40;

bool is_guided(const Resolved& job) {
    return job.guides;
}

bool weighs_by_variance(const Resolved& job) {
    return is_guided(job) && job.guiding.combination == Combination::inverse_variance && !job.budget.strict;
}

/// Samples that the image has if a pass with the last tree is added.
double spp_shown(const RenderHistory& state, const Resolved& job) {
    return job.budget.strict || state.passes.back().record ? 0.0 : state.spp_of_last_tree();
}

double sum_of_fixed_weights(const RenderHistory& state, bool guided) {
    double sum = 0;
    for (const PassFacts& pass : state.passes)
        sum += fixed_weight(pass.spp, pass.spp_before, guided);
    return sum;
}

/// Positive n with ((sum of weights)^2 mse + weight^2 n variance) / (sum of weights + weight n)^2 = wanted: samples of
/// a pass, each of this weight, under `fixed` weights.
double solve_fixed(double sum, double mse, double weight, double variance, double wanted) {
    const double a = wanted * weight * weight;
    const double half_b = wanted * sum * weight - 0.5 * weight * weight * variance;
    const double c = sum * sum * (wanted - mse);
    return (std::sqrt(half_b * half_b - a * c) - half_b) / a;
}

/// Mean squared error after one more pass of so many samples; inverse of spp_to_reach().
double mse_after(const RenderHistory& state, const Resolved& job, double spp, double variance) {
    const double now = state.error.mse();
    if (shows_last_tree_only(job)) return variance / (spp_shown(state, job) + spp);
    if (weighs_by_variance(job)) return 1 / (1 / now + spp / variance);
    if (!is_guided(job)) return now * state.spp() / (state.spp() + spp);
    const double sum = sum_of_fixed_weights(state, true);
    const double weight = spp * fixed_weight(1, state.spp(), true);
    return (sum * sum * now + weight * weight * variance / spp) / ((sum + weight) * (sum + weight));
}

/// Appends a teaching pass to the history, as it is expected to turn out.
void add_teaching_pass(RenderHistory& state, const Resolved& job, std::uint32_t spp, double variance) {
    const double mse = mse_after(state, job, spp, variance);
    PassFacts pass;
    pass.spp = spp;
    pass.spp_before = state.spp();
    pass.record = true;
    state.passes.push_back(pass);
    state.error.rmse = std::sqrt(mse);
}

Trust trust_in(const RenderHistory& state, const Outlook& outlook) {
    const ErrorEstimate& error = state.error;
    if (!error.has_interval || error.high - error.low > 2 * tuned("forecast.noisy") * error.rmse) return Trust::noisy;
    const bool settled = outlook.recent_progress() >= tuned("forecast.learned");
    return settled || !outlook.learning() ? Trust::firm : Trust::learning;
}

}  // namespace

bool shows_last_tree_only(const Resolved& job) {
    return job.budget.strict || (is_guided(job) && job.guiding.combination == Combination::last);
}

double ending_margin(const Resolved& job) {
    return job.budget.strict ? tuned("budget.strict_error_margin") : tuned("budget.error_margin");
}

double ending_variance(const Outlook& outlook, const Resolved& job, int trees) {
    return outlook.variance_after(job.budget.strict ? std::max(trees - 1, 0) : trees);
}

double spp_to_reach(const RenderHistory& state, const Resolved& job, double mse, double variance) {
    const double now = state.error.mse();
    if (shows_last_tree_only(job)) {
        if (!(mse > 0)) return variance > 0 ? kUnknown : 0.0;
        return std::max(0.0, variance / mse - spp_shown(state, job));
    }
    if (now <= mse) return 0;
    if (!(mse > 0)) return kUnknown;
    if (weighs_by_variance(job))
        return std::max<double>(variance * (1 / mse - 1 / now), tuned<std::uint32_t>("schedule.least_weighed_spp"));
    const std::uint32_t done = state.spp();
    if (!is_guided(job)) return done * (now / mse - 1);  // all samples are alike: the image knows their variance best
    return solve_fixed(sum_of_fixed_weights(state, true), now, fixed_weight(1, done, true), variance, mse);
}

ErrorForecast forecast_error(const RenderHistory& state, const Resolved& job, double relative_error) {
    ErrorForecast forecast{relative_error, kUnknown, kUnknown, Trust::none};
    if (!state.error.known || state.passes.empty()) return forecast;
    const double rmse = relative_error * state.error.mean, mse = rmse * rmse;
    if (!job.budget.strict && state.error.mse() <= mse) return {relative_error, 0, 0, Trust::firm};
    const Outlook outlook(state);
    const auto next = static_cast<std::uint32_t>(state.passes.size());
    // If sampling of emitters starts or stops with the next pass, its noise is unknown.
    const bool like_the_last = make_pass(job, next, state.spp(), 1, true).next_event == state.passes.back().next_event;
    if (!outlook.knows_variance() || !like_the_last) return forecast;
    forecast.trust = trust_in(state, outlook);
    const double margin = relative_error == job.budget.error ? ending_margin(job) : 1.0;

    RenderHistory future = state;
    double seconds = 0;
    for (int trees = outlook.learning() ? 1 : 0;; ++trees) {
        const double variance =
            forecast.trust == Trust::learning ? outlook.variance() : ending_variance(outlook, job, trees);
        const double wanted = std::ceil(spp_to_reach(future, job, mse, variance)) * margin;
        const double doubled = std::ldexp(job.guiding.spp_unit, static_cast<int>(future.passes.size()));
        seconds += outlook.overhead_seconds();
        if (!outlook.learning() || wanted < tuned("schedule.teaching_share") * doubled || trees >= kMostTrees) {
            forecast.spp = future.spp() - state.spp() + wanted;
            forecast.seconds = seconds + wanted * outlook.seconds_per_spp(trees, false);
            if (forecast.trust == Trust::firm && forecast.spp > tuned("forecast.far") * state.spp())
                forecast.trust = Trust::noisy;
            return forecast;
        }
        seconds += doubled * outlook.seconds_per_spp(trees, true);
        add_teaching_pass(future, job, static_cast<std::uint32_t>(std::min(doubled, 1e9)), variance);
    }
}

}  // namespace treefarm
