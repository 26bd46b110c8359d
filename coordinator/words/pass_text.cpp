// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/pass_text.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "common/base/status.h"
#include "common/base/text/duration_text.h"

namespace treefarm {

namespace {

bool is_known(const ErrorForecast& forecast) {
    return forecast.trust != Trust::none && forecast.relative_error > 0 && forecast.seconds > 0 &&
           std::isfinite(forecast.seconds);
}

/// "half in about 1:10"; empty if unknown, or if nothing is left to do.
std::string outlook_text(const PassReport& r) {
    const bool asked = r.target.relative_error > 0;
    const ErrorForecast& forecast = asked ? r.target : r.halving;
    if (!is_known(forecast)) return "";
    const std::string what = asked ? fmt::format("{:.3g} %", 100 * forecast.relative_error) : "half";
    return what + " in " + trust_words(forecast.trust) + rough_duration_text(forecast.seconds);
}

}  // namespace

std::string pass_line(const PassReport& r, std::size_t pass_count) {
    return join_fields({pass_name(r.plan.index, pass_count), fmt::format("{} spp", r.spp_done),
                        duration_text(r.run_seconds), brief_error_text(r.error), outlook_text(r)});
}

std::string pass_summary(const PassReport& r, std::size_t pass_count) {
    std::string text =
        fmt::format("{}: {} spp in {:.2f} s ({:.2f} core-s), {:.2f} Mrays/s", pass_name(r.plan.index, pass_count),
                    r.plan.spp, r.seconds.all, r.core_seconds(), 1e-6 * r.rays_per_second());
    // With one sample per pixel there is no variance yet.
    if (r.variance.stuv > 0) text += fmt::format(", stuv {:.4g}, ttuv {:.4g} core-s", r.variance.stuv, r.ttuv());
    text += ", " + error_text(r.error);
    if (r.efficiency() > 0) text += fmt::format(", efficiency {:.3g}", r.efficiency());
    text += fmt::format(", {:.1f} % of paths see light", 100 * r.nonzero_share());
    if (r.tree.regions > 1)
        text += fmt::format("; tree {} nodes, {:.1f} MB", r.tree.nodes, 1e-6 * static_cast<double>(r.tree.memory));
    if (!r.plan.emission.empty()) {
        const auto& [emitters, emitters_of_half] = r.decisions.get<EmissionDecision::Figures>();
        text += fmt::format("; half of the light paths start at {} of {} emitters", emitters_of_half, emitters);
    }
    for (const ErrorForecast& forecast : {r.halving, r.target})
        if (is_known(forecast))
            text += fmt::format("; {:.3g} % in {}", 100 * forecast.relative_error, forecast_text(forecast));
    return text;
}

std::string pass_name(std::uint32_t index, std::size_t pass_count) {
    return fmt::format("pass {}", index + 1) + (pass_count > 0 ? fmt::format("/{}", pass_count) : "");
}

const char* trust_words(Trust trust) {
    switch (trust) {
        case Trust::none:
            break;
        case Trust::learning:
            return "at most ";
        case Trust::noisy:
            return "roughly ";
        case Trust::firm:
            return "about ";
    }
    return "";
}

std::string forecast_text(const ErrorForecast& forecast) {
    std::string time = trust_words(forecast.trust) + rough_duration_text(forecast.seconds);
    switch (forecast.trust) {
        case Trust::none:
            return "an unknown time";
        case Trust::learning:
            return time + " (still learning)";
        case Trust::noisy:
            return time + " (the error itself is not known well)";
        case Trust::firm:
            break;
    }
    return time;
}

std::string brief_error_text(const ErrorEstimate& error) {
    if (!error.known) return "error not known yet";
    if (error.rmse == 0) return error.mean > 0 ? "no noise seen" : "no light found yet";
    return fmt::format("error {:.3g} %", 100 * error.relative());
}

std::string error_text(const ErrorEstimate& error) {
    std::string text = brief_error_text(error);
    if (error.known && error.rmse > 0 && error.has_interval)
        text += fmt::format(" [{:.3g}, {:.3g}]", 100 * error.relative_low(), 100 * error.relative_high());
    return text;
}

}  // namespace treefarm
