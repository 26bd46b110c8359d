// SPDX-License-Identifier: Apache-2.0
#include "report/bench_table.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/error.h"
#include "common/base/files/read_bytes.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

/// Figures that Google Benchmark reports for every benchmark; all other numbers are the program's own counters.
const std::set<std::string> kOfEveryBenchmark = {"family_index",     "per_family_instance_index",
                                                 "repetitions",      "repetition_index",
                                                 "threads",          "iterations",
                                                 "real_time",        "cpu_time",
                                                 "items_per_second", "bytes_per_second"};

/// Last element of this name; appended if there is none.
template <class Named>
Named& named(std::vector<Named>& all, const std::string& name) {
    const auto at = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    if (at != all.end()) return *at;
    all.emplace_back().name = name;
    return all.back();
}

void add_measurement(const Json& json, std::vector<BenchChoice>& choices) {
    if (json.value("run_type", "iteration") != "iteration" || !json.contains("items_per_second")) return;
    const std::string name = json.at("run_name");
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) return;
    std::string variant_name = name.substr(slash + 1);  // its options, which follow the name, are not part of it
    variant_name = variant_name.substr(0, variant_name.find('/'));
    BenchVariant& variant = named(named(choices, name.substr(0, slash)).variants, variant_name);
    variant.nanoseconds.push_back(1e9 / json.at("items_per_second").get<double>());
    if (variant.nanoseconds.size() > 1) return;
    variant.index = json.value("family_index", 0);
    for (const auto& [key, value] : json.items())
        if (value.is_number() && !kOfEveryBenchmark.contains(key)) variant.counters[key] = value;
}

/// Content of a file. Google Benchmark writes NaN, which is no JSON, for spreads of counters that are zero.
std::string read_benchmark(const std::filesystem::path& file) {
    std::string text = read_text(file);
    for (const std::string word : {": -NaN", ": NaN", ": -Infinity", ": Infinity"})
        for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;)
            text.replace(at, word.size(), ": null");
    return text;
}

std::string counters_text(const std::map<std::string, double>& counters) {
    std::string text;
    for (const auto& [key, value] : counters) {
        std::string words = key;
        std::replace(words.begin(), words.end(), '_', ' ');
        text += fmt::format("{}{}: {:.3g}", text.empty() ? "" : "; ", words, value);
    }
    return text;
}

std::string ratio_text(const BenchVariant& own, const BenchVariant& base) {
    const std::size_t pairs = std::min(own.nanoseconds.size(), base.nanoseconds.size());
    const Interval ratio =
        geometric_ratio(std::span(own.nanoseconds).first(pairs), std::span(base.nanoseconds).first(pairs));
    std::string text = fmt::format("{:.2f}", ratio.mean);
    if (std::isfinite(ratio.low)) text += fmt::format(" [{:.2f}, {:.2f}]", ratio.low, ratio.high);
    return text;
}

}  // namespace

std::vector<BenchChoice> read_bench(const std::filesystem::path& file) {
    std::vector<BenchChoice> choices;
    try {
        const Json json = Json::parse(read_benchmark(file));
        for (const Json& benchmark : json.at("benchmarks"))
            add_measurement(benchmark, choices);
    } catch (const Json::exception& error) {
        throw InputError(Location{file.string()}, std::string("is no output of a benchmark: ") + error.what(),
                         "run it with --benchmark_out=FILE --benchmark_out_format=json");
    }
    // Repetitions may be interleaved at random; the program's own order is that of its families.
    for (BenchChoice& choice : choices)
        std::stable_sort(choice.variants.begin(), choice.variants.end(),
                         [](const BenchVariant& a, const BenchVariant& b) { return a.index < b.index; });
    return choices;
}

std::string bench_table(const std::vector<BenchChoice>& choices) {
    std::string text = "| choice | way | ns per item | over the first | |\n|---|---|---|---|---|\n";
    for (const BenchChoice& choice : choices)
        for (const BenchVariant& variant : choice.variants)
            text += fmt::format(
                "| {} | {} | {:.1f} | {} | {} |\n", choice.name, variant.name, geometric_mean(variant.nanoseconds).mean,
                &variant == &choice.variants.front() ? "" : ratio_text(variant, choice.variants.front()),
                counters_text(variant.counters));
    return text;
}

}  // namespace treefarm
