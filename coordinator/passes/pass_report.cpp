// SPDX-License-Identifier: Apache-2.0
#include "coordinator/passes/pass_report.h"

#include <algorithm>

#include "common/plan/forecast/memory.h"

namespace treefarm {

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
    return plan.next_event ? decisions.get<NextEventDecision::Figures>().samples : 0.0;
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

void fill_from_collector(PassReport& report, const Collector& collector, const AnyModel& model) {
    report.stats = collector.totals();
    report.update_bytes = collector.update_bytes();
    report.touched_cells = collector.touched_cells();
    if (report.plan.record) report.caps = model.caps(collector.evidence().of(kGuideEvidence));
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
        s.busy[worker] = contribution.stats.busy_seconds;
        s.trace.mean += trace / static_cast<double>(collector.contributions().size());
        if (first || trace < s.trace.min) s.trace.min = trace;
        if (first || trace > s.trace.max) {
            s.trace.max = trace;
            s.trace.max_worker = worker;
        }
        first = false;
    }
}

std::optional<double> PassSeconds::processor_share(int number) const {
    const auto found = busy.find(number);
    if (found == busy.end() || !(found->second > 0)) return std::nullopt;
    return std::clamp(worker.at(number) / found->second, 0.0, 1.0);
}

void count_idle(PassReport& report) {
    const double busy = std::max(report.stats.busy_seconds, report.core_seconds());
    report.seconds.idle = std::max(0.0, report.seconds.all * report.threads - busy);
}

}  // namespace treefarm
