// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/pass_record.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace treefarm {

namespace {

/// A figure of kPassFigures with its value.
struct Figure {
    RunKey key;
    RunJson value;
    bool in_table = true;  ///< passes.csv has a value for it; false: an empty field
};

/// Name of a trust, in the order of Trust.
const char* trust_name(Trust trust) {
    constexpr const char* kNames[] = {"", "noisy", "learning", "firm"};
    return kNames[static_cast<std::size_t>(trust)];
}

/// Figures of a pass, in the order of kPassFigures.
std::vector<Figure> figures(const PassReport& r) {
    const bool has_goal = r.target.relative_error > 0, has_target = r.error.known && has_goal;
    const Spread& trace = r.seconds.trace;
    const auto timed = [&](RunKey key, TracePhase phase) {
        return Figure{key, r.stats.phase_seconds[static_cast<std::size_t>(phase)], r.stats.phase_seconds[0] > 0};
    };
    RunJson by_worker = RunJson::object();
    for (const auto& [worker, seconds] : r.seconds.worker)
        by_worker[std::to_string(worker)] = seconds;
    std::vector<Figure> figures = {
        {"pass", r.plan.index + 1},
        {"spp", r.plan.spp},
        {"spp_done", r.spp_done},
        {"next_event", r.plan.next_event},
        {"next_event_samples", r.next_event_samples()},
        {"record", r.plan.record},
        {"workers", r.workers},
        {"threads", r.threads},
        {"seconds", r.seconds.all},
        {"broadcast_seconds", r.seconds.broadcast},
        {"trace_seconds_min", trace.min},
        {"trace_seconds_mean", trace.mean},
        {"trace_seconds_max", trace.max},
        {"trace_max_worker", trace.max_worker},
        timed("profile_intersect", TracePhase::intersect),
        timed("profile_surface", TracePhase::surface),
        timed("profile_direction", TracePhase::direction),
        timed("profile_shadow", TracePhase::shadow),
        timed("profile_record", TracePhase::record),
        {"splat_seconds", r.seconds.splat},
        {"idle_seconds", r.seconds.idle},
        {"busy_seconds", r.stats.busy_seconds},
        {"merge_seconds", r.seconds.merge},
        {"refine_seconds", r.seconds.refine},
        {"film_seconds", r.seconds.film},
        {"error_seconds", r.seconds.error},
        {"run_seconds", r.run_seconds},
        {"core_seconds", r.core_seconds()},
        {"stuv", r.variance.stuv},
        {"stuv_trimmed", r.variance.stuv_trimmed},
        {"stuv_ppg", r.variance.stuv_ppg},
        {"ttuv", r.ttuv()},
        {"error", r.error.relative(), r.error.known},
        {"error_low", r.error.relative_low(), r.error.has_interval},
        {"error_high", r.error.relative_high(), r.error.has_interval},
        {"estimated_rmse", r.error.rmse, r.error.known},
        {"efficiency", r.efficiency(), r.error.known},
        {"halving_spp", r.halving.spp, r.error.known},
        {"halving_seconds", r.halving.seconds, r.error.known},
        {"halving_trust", trust_name(r.halving.trust)},
        {"target_spp", r.target.spp, has_target},
        {"target_seconds", r.target.seconds, has_target},
        {"target_trust", has_target ? trust_name(r.target.trust) : ""},
        {"paths", r.stats.paths},
        {"nonzero_share", r.nonzero_share()},
        {"rays", r.stats.rays},
        {"shadow_rays", r.stats.shadow_rays},
        {"rays_per_second", r.rays_per_second()},
        {"vertices", r.stats.vertices},
        {"records", r.stats.records},
        {"invalid_samples", r.stats.invalid_samples},
        {"tree_nodes", r.tree.nodes},
        {"tree_regions", r.tree.regions},
    };
    std::size_t column = 0;
    for (const FigureValue& value : Decisions::values(r.plan, r.decisions))
        figures.push_back({Decisions::kFigures[column++], std::visit([](auto v) { return RunJson(v); }, value)});
    const std::vector<Figure> last = {
        {"tree_views", r.tree.views},
        {"tree_cells", r.tree.cells},
        {"spatial_depth", r.tree.spatial_depth},
        {"directional_depth", r.tree.directional_depth},
        {"tree_bytes", r.tree.bytes},
        {"tree_memory", r.tree.memory},
        {"update_bytes", r.update_bytes},
        {"touched_cells", r.touched_cells},
        {"capped_records", r.caps.capped_records},
        {"saturated_cells", r.caps.saturated_cells},
        {"outside_positions", r.caps.outside_positions},
        {"spatial_depth_capped", r.refine.spatial_depth_capped},
        {"directional_depth_capped", r.refine.directional_depth_capped},
        {"memory_capped", r.refine.memory_capped},
        {"splat_bytes", r.splat_bytes},
        {"phase_seconds", r.seconds.phases()},
        {"trace_seconds",
         RunJson{{"min", trace.min}, {"mean", trace.mean}, {"max", trace.max}, {"max_worker", trace.max_worker}}},
        {"image_error", error_record(r.error)},
        {"halving", forecast_record(r.halving)},
        {"target", has_goal ? forecast_record(r.target) : RunJson()},
        {"worker_seconds", by_worker},
    };
    figures.insert(figures.end(), last.begin(), last.end());
    const auto place = [](const Figure& figure) {
        const std::string_view name = figure.key.name();
        return std::find_if(kPassFigures.begin(), kPassFigures.end(), [name](auto& row) { return row.name == name; });
    };
    std::sort(figures.begin(), figures.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
    return figures;
}

std::string field(const RunJson& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
    return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

}  // namespace

RunJson error_record(const ErrorEstimate& error) {
    if (!error.known) return nullptr;
    const auto end = [&](double value) { return error.has_interval ? RunJson(value) : RunJson(); };
    return {{"relative", error.relative()},
            {"low", end(error.relative_low())},
            {"high", end(error.relative_high())},
            {"rmse", error.rmse},
            {"rmse_low", end(error.low)},
            {"rmse_high", end(error.high)},
            {"mean", error.mean}};
}

RunJson forecast_record(const ErrorForecast& forecast) {
    return {{"relative_error", forecast.relative_error},
            {"spp", forecast.spp},
            {"seconds", forecast.seconds},
            {"trust", trust_name(forecast.trust)}};
}

RunJson pass_record(const PassReport& report, unsigned place) {
    RunJson record = RunJson::object();
    const std::vector<Figure> all = figures(report);
    for (std::size_t k = 0; k < all.size(); ++k)
        if (kPassFigures[k].places & place) record[all[k].key.name()] = all[k].value;
    return record;
}

std::string pass_csv_header() {
    std::string line;
    for (const PassFigure& figure : kPassFigures)
        if (figure.places & kInTable) line += (line.empty() ? "" : ",") + std::string(figure.name);
    return line;
}

std::string pass_csv_line(const PassReport& report) {
    std::string line;
    const std::vector<Figure> all = figures(report);
    for (std::size_t k = 0; k < all.size(); ++k)
        if (kPassFigures[k].places & kInTable)
            line += (k == 0 ? "" : ",") + (all[k].in_table ? field(all[k].value) : std::string());
    return line;
}

}  // namespace treefarm
