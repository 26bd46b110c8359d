// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/statistics.h"

namespace treefarm {

/// A way of doing something, measured by a program of bench/.
struct BenchVariant {
    std::string name;
    int index = 0;                           ///< among the program's benchmarks
    std::vector<double> nanoseconds;         ///< of the processor, per item, by repetition
    std::map<std::string, double> counters;  ///< what else the program says of it, of the first repetition
};

/// Variants of one choice; the first is what the renderer does.
struct BenchChoice {
    std::string name;
    std::vector<BenchVariant> variants;
};

/// Reads what Google Benchmark writes under --benchmark_format=json, of benchmarks that are called CHOICE/VARIANT.
/// Throws InputError where it cannot be read.
std::vector<BenchChoice> read_bench(const std::filesystem::path& file);

/// A Markdown table: time per item over that of the first variant, paired by repetition, and the counters.
std::string bench_table(const std::vector<BenchChoice>& choices);

}  // namespace treefarm
