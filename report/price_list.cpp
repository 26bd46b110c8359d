// SPDX-License-Identifier: Apache-2.0
#include "report/price_list.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "common/base/files/atomic_file.h"

namespace treefarm {

namespace {

using Figure = double (*)(const PassRow&);

double square(double x) {
    return x * x;
}

struct Column {
    const char* name;
    Figure figure;
};

const Column kColumns[] = {
    {"core-seconds", [](const PassRow& r) { return r.core_seconds; }},
    {"seconds", [](const PassRow& r) { return r.run_seconds; }},
    {"relMSE", [](const PassRow& r) { return square(measures()[1].value(r)); }},
    {"relMSE trimmed", [](const PassRow& r) { return square(measures()[2].value(r)); }},
    {"relMSE x core-seconds", [](const PassRow& r) { return square(measures()[1].value(r)) * r.core_seconds; }},
    {"trimmed x core-seconds", [](const PassRow& r) { return square(measures()[2].value(r)) * r.core_seconds; }},
};

/// Ratio of a method's figure to the baseline's, by pairs of seeds.
Interval ratio(const std::vector<const CellResult*>& own, const std::vector<const CellResult*>& base, Figure figure) {
    std::vector<double> a, b;
    for (const CellResult* cell : own)
        for (const CellResult* other : base)
            if (cell->repetition == other->repetition) {
                a.push_back(figure(cell->passes.back()));
                b.push_back(figure(other->passes.back()));
            }
    return geometric_ratio(a, b);
}

/// Text of an interval, bold if it does not contain 1 in its printed digits.
std::string cell_text(const Interval& interval) {
    if (!std::isfinite(interval.mean)) return "";
    std::string text = fmt::format("{:.2f}", interval.mean);
    if (!std::isfinite(interval.low)) return text;
    const bool certain = std::round(100 * interval.low) > 100 || std::round(100 * interval.high) < 100;
    if (certain) text = "**" + text + "**";
    return text + fmt::format(" [{:.2f}, {:.2f}]", interval.low, interval.high);
}

std::string scene_table(const StudyResults& study, const SceneResult& scene) {
    const auto base = study.of(scene.name, study.baseline);
    if (base.empty()) return "";
    const PassRow& last = base.front()->passes.back();
    std::string text = fmt::format(
        "## {}: {}\n\n{} x {} pixels, {} spp, {} seeds, {} threads; `{}`: {:.3g} core-seconds, root of relMSE "
        "{:.3g} %, trimmed {:.3g} %; the reference's own error is {:.2g} % of the mean.\n\n| choice |",
        std::filesystem::path(study.study).stem().string(), scene.name, base.front()->width, base.front()->height,
        last.spp_done, base.size(), last.threads, study.baseline, last.core_seconds, 100 * measures()[1].value(last),
        100 * measures()[2].value(last), 100 * scene.reference_error);
    std::string rule = "|---|";
    for (const Column& column : kColumns) {
        text += fmt::format(" {} |", column.name);
        rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const MethodResult& method : study.methods) {
        if (method.name == study.baseline) continue;
        text += "| " + method.name + " |";
        for (const Column& column : kColumns)
            text += " " + cell_text(ratio(study.of(scene.name, method.name), base, column.figure)) + " |";
        text += "\n";
    }
    return text + "\n";
}

}  // namespace

std::string price_list(const std::vector<StudyResults>& studies, const std::vector<BenchChoice>& benches) {
    std::string text =
        "# The cost of accuracy\n\n"
        "Written by `deploy/cost-of-accuracy`; do not edit. What each choice costs and buys on our own scenes: ratios "
        "over the baseline at\n"
        "equal samples, geometric means over pairs of seeds with 95 % intervals of Student's t. Below 1 is better in "
        "every column; bold: the\n"
        "interval does not hold 1. The last two columns are the price of accuracy: how many times the core-seconds an "
        "image of equal\n"
        "error takes. A claim needs both, untrimmed and without the worst 0.1 % of the pixels "
        "([metrics.md](../design/metrics.md)).\n\n"
        "Core-seconds are the workers' own processor time, so a busy machine moves them little; seconds are the "
        "clock's, and it moves them a lot.\n"
        "With so few seeds, one in twenty intervals that hold no 1 is an accident. Effects that are off make the image "
        "wrong: their rows\n"
        "show the time that an effect takes, and their relMSE what the image loses.\n\n";
    for (const StudyResults& study : studies)
        for (const SceneResult& scene : study.scenes)
            text += scene_table(study, scene);
    std::vector<BenchChoice> exactness, materials;
    for (const BenchChoice& choice : benches)
        (choice.name == "materials" ? materials : exactness).push_back(choice);
    if (!materials.empty())
        text +=
            "## Materials\n\nWhat a kind of material costs a vertex of a path: one sample and one value, by "
            "`bench/material_bench` alone on one\nthread. Scenes without a kind do not pay for it.\n\n" +
            bench_table(materials) + "\n";
    if (!exactness.empty())
        text +=
            "## Exactness\n\nChoices that no job key makes, measured by `bench/precision_bench` alone on one thread: "
            "what "
            "the renderer does comes\nfirst. Sums that depend on the order of their records would give other images "
            "with "
            "other numbers of workers.\n\n" +
            bench_table(exactness);
    while (text.ends_with("\n\n"))
        text.pop_back();
    return text;
}

void write_price_list(const std::vector<std::filesystem::path>& folders,
                      const std::vector<std::filesystem::path>& benches, const std::filesystem::path& file) {
    std::vector<StudyResults> studies;
    studies.reserve(folders.size());
    for (const std::filesystem::path& folder : folders)
        studies.push_back(read_study_results(folder));
    std::vector<BenchChoice> choices;
    for (const std::filesystem::path& bench : benches)
        for (BenchChoice& choice : read_bench(bench))
            choices.push_back(std::move(choice));
    const std::string text = price_list(studies, choices);
    write_output_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace treefarm
