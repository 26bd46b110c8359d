// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/cell_record.h"

#include <nlohmann/json.hpp>

#include "common/metrics/error_metrics.h"
#include "common/metrics/flip/measure_flip.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

Json error_record(const RgbImage& image, const RgbImage& reference) {
    const ErrorMetrics m = measure_error(image, reference);
    return {{"rmse_over_mean", m.rmse / m.mean_reference},
            {"rel_mse", m.rel_mse},
            {"rel_mse_trimmed", m.rel_mse_trimmed},
            {"mape", m.mape},
            {"smape", m.smape},
            {"outliers", m.outliers},
            {"mean_ratio", m.mean_ratio}};
}

Json pass_record(const PassReport& r, double core_seconds) {
    Json workers = Json::object();
    for (const auto& [worker, seconds] : r.seconds.worker)
        workers[std::to_string(worker)] = seconds;
    return {{"pass", r.plan.index},
            {"spp", r.plan.spp},
            {"spp_done", r.spp_done},
            {"run_seconds", r.run_seconds},
            {"core_seconds", core_seconds},
            {"estimate", r.error.known ? Json{{"relative", r.error.relative()},
                                              {"low", r.error.has_interval ? Json(r.error.relative_low()) : Json()},
                                              {"high", r.error.has_interval ? Json(r.error.relative_high()) : Json()}}
                                       : Json()},
            {"halving_seconds", r.halving.seconds},
            {"halving_trust", trust_name(r.halving.trust)},
            {"target_seconds", r.target.relative_error > 0 ? Json(r.target.seconds) : Json()},
            {"target_trust", r.target.relative_error > 0 ? trust_name(r.target.trust) : ""},
            {"stuv", r.variance.stuv},
            {"stuv_trimmed", r.variance.stuv_trimmed},
            {"ttuv", r.ttuv()},
            {"nonzero_share", r.nonzero_share()},
            {"tree_nodes", r.tree.nodes},
            {"tree_memory", r.tree.memory},
            {"rays", r.stats.rays + r.stats.shadow_rays},
            {"threads", r.threads},
            {"phases", r.seconds.phases()},
            {"worker_seconds", workers},
            {"idle_seconds", r.seconds.idle}};
}

}  // namespace

Json render_record(const std::vector<MeasuredPass>& passes, const RgbImage& reference) {
    Json list = Json::array();
    double core_seconds = 0;
    for (const MeasuredPass& pass : passes) {
        core_seconds += pass.report.core_seconds();
        Json record = pass_record(pass.report, core_seconds);
        record["measured"] = error_record(pass.image, reference);
        list.push_back(std::move(record));
    }
    return {{"width", reference.width},
            {"height", reference.height},
            {"flip", measure_flip(passes.back().image, reference).hdr.mean},
            {"passes", list}};
}

}  // namespace treefarm
