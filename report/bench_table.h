// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/statistics.h"

namespace treefarm {

/// Measurement of one variant by a program of bench/.
struct BenchVariant {
    std::string name;
    int index = 0;                           ///< position among the program's benchmarks
    std::vector<double> nanoseconds;         ///< processor time per item, one value per repetition
    std::map<std::string, double> counters;  ///< further figures of the program, from the first repetition
};

/// Variants of one choice; the first is the renderer's.
struct BenchChoice {
    std::string name;
    std::vector<BenchVariant> variants;
};

/// Results in Google Benchmark's JSON (--benchmark_format=json), of benchmarks named CHOICE/VARIANT. Throws InputError
/// if the file is unreadable.
std::vector<BenchChoice> read_bench(const std::filesystem::path& file);

/// Markdown table: time per item over that of the first variant, paired by repetition, and the counters.
std::string bench_table(const std::vector<BenchChoice>& choices);

}  // namespace treefarm
