// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/cell_record.h"

#include "common/metrics/error_metrics.h"
#include "common/metrics/flip/measure_flip.h"
#include "common/runs/run_json.h"
#include "coordinator/run/pass_record.h"

namespace treefarm {

namespace {

RunJson measured_record(const RgbImage& image, const RgbImage& reference) {
    const ErrorMetrics m = measure_error(image, reference);
    return {{"rmse_over_mean", m.rmse / m.mean_reference},
            {"rel_mse", m.rel_mse},
            {"rel_mse_trimmed", m.rel_mse_trimmed},
            {"mape", m.mape},
            {"smape", m.smape},
            {"outliers", m.outliers},
            {"mean_ratio", m.mean_ratio}};
}

}  // namespace

RunJson render_record(const std::vector<MeasuredPass>& passes, const RgbImage& reference) {
    RunJson list = RunJson::array();
    double core_seconds = 0;
    for (const MeasuredPass& pass : passes) {
        core_seconds += pass.report.core_seconds();
        RunJson record = pass_record(pass.report, kInCell);
        record["core_seconds"] = core_seconds;
        record["measured"] = measured_record(pass.image, reference);
        list.push_back(std::move(record));
    }
    return {{"width", reference.width},
            {"height", reference.height},
            {"flip", measure_flip(passes.back().image, reference).hdr.mean},
            {"passes", list}};
}

}  // namespace treefarm
