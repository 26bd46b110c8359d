// SPDX-License-Identifier: Apache-2.0
#include "coordinator/pass_report.h"

#include <spdlog/fmt/fmt.h>

#include <functional>

#include "common/plan/memory.h"

namespace treefarm {

namespace {

/// One column of passes.csv.
struct Column {
    const char* name;
    std::function<std::string(const PassReport&)> value;
};

template <class Get>
Column column(const char* name, Get get) {
    return {name, [get](const PassReport& r) { return fmt::format("{}", get(r)); }};
}

/// An empty field where a figure is not known.
std::string only_if(bool known, double value) {
    return known ? fmt::format("{}", value) : std::string();
}

/// Thread-seconds, empty where nobody timed them.
Column phase_column(const char* name, TracePhase phase) {
    return {name, [phase](const PassReport& r) {
                const double seconds = r.stats.phase_seconds[static_cast<std::size_t>(phase)];
                return only_if(r.stats.phase_seconds[0] > 0, seconds);
            }};
}

bool has_target(const PassReport& report) {
    return report.error.known && report.target.relative_error > 0;
}

std::vector<Column> columns() {
    using R = const PassReport&;
    return {
        column("pass", [](R r) { return r.plan.index; }),
        column("spp", [](R r) { return r.plan.spp; }),
        column("spp_done", [](R r) { return r.spp_done; }),
        column("next_event", [](R r) { return r.plan.next_event ? 1 : 0; }),
        column("next_event_n", [](R r) { return r.next_event_samples(); }),
        column("next_event_low", [](R r) { return r.refine.next_event.low; }),
        column("next_event_saved", [](R r) { return r.refine.next_event.saved; }),
        column("record", [](R r) { return r.plan.record ? 1 : 0; }),
        column("workers", [](R r) { return r.workers; }),
        column("threads", [](R r) { return r.threads; }),
        column("seconds", [](R r) { return r.seconds.all; }),
        column("broadcast_seconds", [](R r) { return r.seconds.broadcast; }),
        column("trace_seconds_min", [](R r) { return r.seconds.trace.min; }),
        column("trace_seconds_mean", [](R r) { return r.seconds.trace.mean; }),
        column("trace_seconds_max", [](R r) { return r.seconds.trace.max; }),
        column("trace_max_worker", [](R r) { return r.seconds.trace.max_worker; }),
        phase_column("profile_intersect", TracePhase::intersect),
        phase_column("profile_surface", TracePhase::surface),
        phase_column("profile_direction", TracePhase::direction),
        phase_column("profile_shadow", TracePhase::shadow),
        phase_column("profile_record", TracePhase::record),
        column("splat_seconds", [](R r) { return r.seconds.splat; }),
        column("idle_seconds", [](R r) { return r.seconds.idle; }),
        column("merge_seconds", [](R r) { return r.seconds.merge; }),
        column("refine_seconds", [](R r) { return r.seconds.refine; }),
        column("film_seconds", [](R r) { return r.seconds.film; }),
        column("error_seconds", [](R r) { return r.seconds.error; }),
        column("run_seconds", [](R r) { return r.run_seconds; }),
        column("core_seconds", [](R r) { return r.core_seconds(); }),
        column("stuv", [](R r) { return r.variance.stuv; }),
        column("stuv_trimmed", [](R r) { return r.variance.stuv_trimmed; }),
        column("stuv_ppg", [](R r) { return r.variance.stuv_ppg; }),
        column("ttuv", [](R r) { return r.ttuv(); }),
        column("error", [](R r) { return only_if(r.error.known, r.error.relative()); }),
        column("error_low", [](R r) { return only_if(r.error.has_interval, r.error.relative_low()); }),
        column("error_high", [](R r) { return only_if(r.error.has_interval, r.error.relative_high()); }),
        column("estimated_rmse", [](R r) { return only_if(r.error.known, r.error.rmse); }),
        column("efficiency", [](R r) { return only_if(r.error.known, r.efficiency()); }),
        column("halving_spp", [](R r) { return only_if(r.error.known, r.halving.spp); }),
        column("halving_seconds", [](R r) { return only_if(r.error.known, r.halving.seconds); }),
        column("halving_trust", [](R r) { return trust_name(r.halving.trust); }),
        column("target_spp", [](R r) { return only_if(has_target(r), r.target.spp); }),
        column("target_seconds", [](R r) { return only_if(has_target(r), r.target.seconds); }),
        column("target_trust", [](R r) { return has_target(r) ? trust_name(r.target.trust) : ""; }),
        column("paths", [](R r) { return r.stats.paths; }),
        column("nonzero_share", [](R r) { return r.nonzero_share(); }),
        column("rays", [](R r) { return r.stats.rays; }),
        column("shadow_rays", [](R r) { return r.stats.shadow_rays; }),
        column("rays_per_second", [](R r) { return r.rays_per_second(); }),
        column("vertices", [](R r) { return r.stats.vertices; }),
        column("records", [](R r) { return r.stats.records; }),
        column("invalid_samples", [](R r) { return r.stats.invalid_samples; }),
        column("tree_nodes", [](R r) { return r.tree.nodes; }),
        column("tree_regions", [](R r) { return r.tree.regions; }),
        column("guided", [](R r) { return std::uint64_t{r.plan.guided}; }),
        column("worth", [](R r) { return r.guiding_efficiency.efficiency; }),
        column("worth_low", [](R r) { return r.guiding_efficiency.low(); }),
        column("worth_high", [](R r) { return r.guiding_efficiency.high(); }),
        column("worth_known", [](R r) { return r.guiding_efficiency.known; }),
        column("unguided_variance", [](R r) { return r.guiding_efficiency.unguided_variance; }),
        column("split", [](R r) { return std::uint64_t{r.plan.split}; }),
        column("splitting_quietens", [](R r) { return r.splitting_gain.variance; }),
        column("splitting_rays", [](R r) { return r.splitting_gain.rays; }),
        column("splitting_found", [](R r) { return r.splitting_gain.mean_ratio; }),
        column("light_subpaths", [](R r) { return std::uint64_t{r.has_light_subpaths()}; }),
        column("light_subpaths_quieten", [](R r) { return r.light_subpath_gain.noise; }),
        column("light_subpaths_rays", [](R r) { return r.light_subpath_gain.rays; }),
        column("camera_paths_found", [](R r) { return r.light_subpath_gain.mean_ratio; }),
        column("emitters", [](R r) { return r.emitters; }),
        column("emitters_of_half", [](R r) { return r.emitters_of_half; }),
        column("tree_views", [](R r) { return r.tree.views; }),
        column("tree_cells", [](R r) { return r.tree.cells; }),
        column("spatial_depth", [](R r) { return r.tree.spatial_depth; }),
        column("directional_depth", [](R r) { return r.tree.directional_depth; }),
        column("tree_bytes", [](R r) { return r.tree.bytes; }),
        column("tree_memory", [](R r) { return r.tree.memory; }),
        column("update_bytes", [](R r) { return r.update_bytes; }),
        column("touched_cells", [](R r) { return r.touched_cells; }),
        column("capped_records", [](R r) { return r.caps.capped_records; }),
        column("saturated_cells", [](R r) { return r.caps.saturated_cells; }),
        column("outside_positions", [](R r) { return r.caps.outside_positions; }),
        column("spatial_depth_capped", [](R r) { return r.refine.spatial_depth_capped; }),
        column("directional_depth_capped", [](R r) { return r.refine.directional_depth_capped; }),
        column("memory_capped", [](R r) { return r.refine.memory_capped; }),
    };
}

template <class Text>
std::string join_columns(Text text) {
    std::string line;
    for (const Column& c : columns())
        line += (line.empty() ? "" : ",") + text(c);
    return line;
}

}  // namespace

TreeFigures tree_figures(const AnyModel& model, std::uint64_t encoded_bytes) {
    TreeFigures figures{model.figures(), encoded_bytes, 0};
    const TreeSize size{figures.regions,
                        figures.cells,
                        false,
                        figures.views,
                        model.regions().learns_lights(),
                        model.cost(),
                        model.regions().decides_next_event()};
    figures.memory = size.guide_bytes() + size.sum_bytes();
    return figures;
}

double PassReport::next_event_samples() const {
    if (!plan.next_event) return 0.0;
    const NextEventSums& sums = stats.next_event;
    if (sums[kNextEventAsked] == 0) return 1.0;
    return static_cast<double>(sums[kNextEventDrawn]) / static_cast<double>(sums[kNextEventAsked]);
}

double PassReport::nonzero_share() const {
    return stats.paths > 0 ? static_cast<double>(stats.nonzero_paths) / static_cast<double>(stats.paths) : 0.0;
}

double PassReport::rays_per_second() const {
    return seconds.all > 0 ? static_cast<double>(stats.rays + stats.shadow_rays) / seconds.all : 0.0;
}

double PassReport::core_seconds() const {
    return stats.trace_seconds + seconds.splat;
}

double PassReport::ttuv() const {
    return plan.spp > 0 ? variance.stuv * core_seconds() / plan.spp : 0.0;
}

double PassReport::efficiency() const {
    const double product = error.mse() * run_seconds;
    return product > 0 ? 1 / product : 0.0;
}

void fill_from_collector(PassReport& report, const Collector& collector) {
    report.stats = collector.totals();
    report.update_bytes = collector.update_bytes();
    report.touched_cells = collector.touched_cells();
    report.caps = collector.sums().caps();
    report.splat_caps = collector.splats().caps();
    report.splat_bytes = collector.splat_bytes();
    report.saturated_splats = collector.splats().saturated();
    PassSeconds& s = report.seconds;
    s.merge = collector.merge_seconds();
    s.film += collector.film_seconds();
    s.splat = report.stats.splat_seconds;
    bool first = true;
    for (const auto& [worker, contribution] : collector.contributions()) {
        const double trace = contribution.stats.trace_seconds;
        s.worker[worker] = trace + contribution.stats.splat_seconds;
        s.trace.mean += trace / static_cast<double>(collector.contributions().size());
        if (first || trace < s.trace.min) s.trace.min = trace;
        if (first || trace > s.trace.max) {
            s.trace.max = trace;
            s.trace.max_worker = worker;
        }
        first = false;
    }
}

void count_idle(PassReport& report) {
    report.seconds.idle = std::max(0.0, report.seconds.all * report.threads - report.core_seconds());
}

std::string pass_csv_header() {
    return join_columns([](const Column& c) { return std::string(c.name); });
}

std::string pass_csv_line(const PassReport& report) {
    return join_columns([&](const Column& c) { return c.value(report); });
}

const char* trust_name(Trust trust) {
    switch (trust) {
        case Trust::none:
            return "";
        case Trust::learning:
            return "learning";
        case Trust::noisy:
            return "noisy";
        case Trust::firm:
            return "firm";
    }
    return "";
}

}  // namespace treefarm
