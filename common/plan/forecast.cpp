#include "common/plan/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treefarm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Of a clock that did not move, seconds.
constexpr double kShortestSample = 1e-9;

bool is_guided(const Job& job) {
    return job.guiding.type != GuidingType::none;
}

/// Positive n of ((sum of weights)^2 mse + weight^2 n variance) / (sum of weights + weight n)^2 = wanted: how `fixed`
/// weights take in a pass of n samples, each of this weight.
double solve_fixed(double sum, double mse, double weight, double variance, double wanted) {
    const double a = wanted * weight * weight;
    const double half_b = wanted * sum * weight - 0.5 * weight * weight * variance;
    const double c = sum * sum * (wanted - mse);
    return (std::sqrt(half_b * half_b - a * c) - half_b) / a;
}

}  // namespace

bool shows_last_pass_only(const Job& job) {
    return job.budget.strict || (is_guided(job) && job.guiding.combination == Combination::last);
}

double spp_to_reach(const RenderState& state, const Job& job, double mse) {
    const auto known =
        std::find_if(state.passes.rbegin(), state.passes.rend(), [](const PassFacts& pass) { return pass.spp >= 2; });
    if (!state.error.known || known == state.passes.rend()) return kUnknown;
    const double variance = known->mse_of_sample, now = state.error.mse();
    if (shows_last_pass_only(job)) return mse > 0 ? variance / mse : variance > 0 ? kUnknown : 0.0;
    if (now <= mse) return 0;
    if (!(mse > 0)) return kUnknown;
    const bool guided = is_guided(job);
    if (guided && job.guiding.combination == Combination::inverse_variance)
        return std::max<double>(variance * (1 / mse - 1 / now), kMinSamplesForVariance);
    const std::uint32_t done = state.spp();
    if (!guided) return done * (now / mse - 1);  // all samples are alike: the image knows their variance best
    double sum = 0;
    for (const PassFacts& pass : state.passes)
        sum += fixed_weight(pass.spp, pass.spp_before, guided);
    return solve_fixed(sum, now, fixed_weight(1, done, guided), variance, mse);
}

double seconds_per_spp(const RenderState& state) {
    std::uint32_t largest = 0;
    for (const PassFacts& pass : state.passes)
        largest = std::max(largest, pass.spp);
    // The last pass; where that was a small one, which tells little, those before it, too.
    double seconds = 0, spp = 0;
    for (auto pass = state.passes.rbegin(); pass != state.passes.rend() && 2 * spp < largest; ++pass) {
        seconds += pass->trace_seconds;
        spp += pass->spp;
    }
    return std::max(seconds / spp, kShortestSample);
}

double seconds_of_pass(const RenderState& state, double spp) {
    return state.passes.back().overhead_seconds + spp * seconds_per_spp(state);
}

ErrorForecast forecast_error(const RenderState& state, const Job& job, double relative_error) {
    const double rmse = relative_error * state.error.mean;
    const double spp = std::ceil(spp_to_reach(state, job, rmse * rmse));
    return {relative_error, spp, spp > 0 ? seconds_of_pass(state, spp) : 0.0};
}

}  // namespace treefarm
