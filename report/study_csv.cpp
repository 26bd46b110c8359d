// SPDX-License-Identifier: Apache-2.0
#include "report/study_csv.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace treefarm {

namespace {

constexpr const char* kErrors[] = {"rmse_over_mean", "rel_mse",  "rel_mse_trimmed", "mape",
                                   "smape",          "outliers", "mean_ratio"};

std::string field(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string quoted(const std::string& text) {
    return text.find_first_of(",\"") == std::string::npos ? text : '"' + text + '"';
}

std::string header(const char* more) {
    std::string line = std::string("scene,method,budget,seed,repetition,") + more +
                       "spp,threads,run_seconds,core_seconds,estimated_error,halving_seconds,stuv,ttuv,nonzero_share,"
                       "tree_nodes,tree_memory";
    for (const char* error : kErrors)
        line += std::string(",") + error;
    return line;
}

std::string names(const CellResult& cell) {
    return fmt::format("{},{},{},{},{}", quoted(cell.scene), quoted(cell.method), quoted(cell.budget), cell.seed,
                       cell.repetition);
}

std::string figures(const PassRow& row) {
    std::string line = fmt::format("{},{},{},{},{},{},{},{},{},{},{}", row.spp_done, row.threads, row.run_seconds,
                                   row.core_seconds, field(row.estimate), field(row.halving.seconds), row.stuv,
                                   row.ttuv, row.nonzero_share, row.tree_nodes, row.tree_memory);
    for (const char* error : kErrors)
        line += "," + field(row.measured.at(error));
    return line;
}

}  // namespace

std::string cells_csv(const StudyResults& results) {
    std::string text = header("") + ",flip,width,height\n";
    for (const CellResult& cell : results.cells)
        text += fmt::format("{},{},{},{},{}\n", names(cell), figures(cell.passes.back()), field(cell.flip), cell.width,
                            cell.height);
    return text;
}

std::string passes_csv(const StudyResults& results) {
    std::string text = header("pass,") + "\n";
    for (const CellResult& cell : results.cells)
        for (const PassRow& row : cell.passes)
            text += fmt::format("{},{},{}\n", names(cell), row.pass, figures(row));
    return text;
}

}  // namespace treefarm
