// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/bench_table.h"
#include "report/study_results.h"

namespace treefarm {

/// Costs and gains of each method of the studies against its study's baseline, as a Markdown page: a table per scene,
/// ratios over pairs of seeds with 95 % intervals. For studies at equal samples. `benches`: choices without a job key.
std::string price_list(const std::vector<StudyResults>& studies, const std::vector<BenchChoice>& benches);

/// Writes the list of these folders' studies and of benchmark output files. Throws InputError if one cannot be read,
/// RunError if the list cannot be written.
void write_price_list(const std::vector<std::filesystem::path>& folders,
                      const std::vector<std::filesystem::path>& benches, const std::filesystem::path& file);

}  // namespace treefarm
