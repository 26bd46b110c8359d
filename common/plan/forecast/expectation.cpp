// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/expectation.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/plan/forecast/forecast.h"

namespace treefarm {

namespace {

/// Relative spread of error and speed of a second, equal render; more for each doubling of samples that a forecast
/// looks ahead.
constexpr double kSpread = 0.12;
constexpr double kSpreadPerDoubling = 0.03;
constexpr double kSpeedSpread = 0.15;
constexpr double kSpeedSpreadPerDoubling = 0.02;
/// Factor, up and down, for an error without interval.
constexpr double kUnknownSpread = 2.0;
/// Relative width of an upper interval above which an error is attributed to rare samples.
constexpr double kWide = 0.1;
/// Number of further trees after which nothing more is learned.
constexpr int kManyTrees = 10;

/// Factors below and above 1 by which a mean squared error, and so the samples for a given error, may be wrong.
struct Doubt {
    double low = 1, high = 1, speed = 1;
};

Expected around(double value, double low, double high) {
    return {value, value * low, value * high};
}

Doubt doubt_of(const RenderHistory& state, double spp) {
    const ErrorEstimate& error = state.error;
    const double doublings = std::max(0.0, std::log2(spp / std::max(1u, state.spp())));
    const double spread = (1 + kSpread) * (1 + kSpreadPerDoubling * doublings);
    Doubt doubt;
    // The error's interval is of this image; the variance of a sample, which decides, is known better. But a wide
    // interval means rare samples, which a probe has hardly seen and which only make a render longer.
    const double low = error.has_interval ? error.low / error.rmse : 1 / kUnknownSpread;
    const double high = error.has_interval ? error.high / error.rmse : kUnknownSpread;
    doubt.low = low / spread;
    doubt.high = (high > 1 + kWide ? high * high : high) * spread;
    doubt.speed = (1 + kSpeedSpread) * (1 + kSpeedSpreadPerDoubling * doublings);
    // The gain of further trees is a guess between none and the gain of the last ones.
    const Outlook outlook(state);
    if (outlook.learning() && outlook.variance() > 0) {
        const double hope = outlook.variance_after(kManyTrees) / outlook.variance();
        doubt.low *= hope;
        doubt.high /= std::sqrt(hope);
    }
    return doubt;
}

/// Reason why there is no expectation; "" if there is one.
std::string why_unknown(const RenderHistory& state) {
    if (!state.error.known) return "the probe has too few samples to tell its error";
    if (!(state.error.mean > 0)) return "no light was found in the probe: check the scene's emitters and camera";
    return "";
}

/// Expectation of a render without noise, or of one whose end the probe reached.
Expectation measured(const RenderHistory& state) {
    Expectation all;
    all.known = all.reached = true;
    const double spp = state.spp();
    all.spp = {spp, spp, spp};
    all.seconds = around(state.seconds, 1 / (1 + kSpeedSpread), 1 + kSpeedSpread);
    all.error = {state.error.relative(), state.error.relative_low(), state.error.relative_high()};
    return all;
}

ErrorForecast ahead(const RenderHistory& state, const Resolved& job, double error) {
    return forecast_error(state, job, error);
}

/// Error at which `figure` of the forecast reaches `wanted`; it grows as the error falls.
double error_where(const RenderHistory& state, const Resolved& job, double wanted,
                   const std::function<double(const ErrorForecast&)>& figure) {
    constexpr double kLeast = 1e-4;
    constexpr int kSteps = 40;
    double low = kLeast * state.error.relative(), high = state.error.relative();
    for (int step = 0; step < kSteps; ++step) {
        const double middle = std::sqrt(low * high);
        (figure(ahead(state, job, middle)) > wanted ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

Expectation expectation_at(const RenderHistory& state, const Resolved& job, double error) {
    const ErrorForecast forecast = ahead(state, job, error);
    Expectation all;
    if (!std::isfinite(forecast.spp) || !std::isfinite(forecast.seconds)) {
        all.unknown = "the probe does not tell what samples will be like once next event changes";
        return all;
    }
    all.known = true;
    const double spp = state.spp() + forecast.spp;
    const Doubt doubt = doubt_of(state, spp);
    const double done = state.spp();
    all.spp = {spp, std::max(done, spp * doubt.low), spp * doubt.high};
    all.seconds = around(state.seconds + forecast.seconds, doubt.low / doubt.speed, doubt.high * doubt.speed);
    all.error = {error, error, error};
    return all;
}

}  // namespace

Expectation expect_error(const RenderHistory& state, const Resolved& job, double relative_error) {
    Expectation all;
    if (all.unknown = why_unknown(state); !all.unknown.empty()) return all;
    if (!(state.error.rmse > 0) || state.error.relative() <= relative_error) return measured(state);
    return expectation_at(state, job, relative_error);
}

Expectation expect_after_seconds(const RenderHistory& state, const Resolved& job, double seconds) {
    Expectation all;
    if (all.unknown = why_unknown(state); !all.unknown.empty()) return all;
    if (!(state.error.rmse > 0) || state.seconds >= seconds) return measured(state);
    const double error = error_where(state, job, seconds - state.seconds,
                                     [](const ErrorForecast& forecast) { return forecast.seconds; });
    all = expectation_at(state, job, error);
    if (!all.known) return all;
    const Doubt doubt = doubt_of(state, all.spp.value);
    all.seconds = {seconds, seconds, seconds};
    all.spp = around(all.spp.value, 1 / doubt.speed, doubt.speed);
    all.error = around(error, std::sqrt(doubt.low / doubt.speed), std::sqrt(doubt.high * doubt.speed));
    return all;
}

Expectation expect_after_spp(const RenderHistory& state, const Resolved& job, double spp) {
    Expectation all;
    if (all.unknown = why_unknown(state); !all.unknown.empty()) return all;
    if (!(state.error.rmse > 0) || state.spp() >= spp) return measured(state);
    const double error =
        error_where(state, job, spp - state.spp(), [](const ErrorForecast& forecast) { return forecast.spp; });
    all = expectation_at(state, job, error);
    if (!all.known) return all;
    const Doubt doubt = doubt_of(state, spp);
    all.spp = {spp, spp, spp};
    all.seconds = around(all.seconds.value, 1 / doubt.speed, doubt.speed);
    all.error = around(error, std::sqrt(doubt.low), std::sqrt(doubt.high));
    return all;
}

}  // namespace treefarm
