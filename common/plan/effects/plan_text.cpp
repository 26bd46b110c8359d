// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/plan_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/plan/effects/effect_table.h"

namespace treefarm {
namespace {

using Json = nlohmann::ordered_json;

using Row = std::vector<std::string>;

/// Table whose columns are as wide as their longest entry, except for the last.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], row[c].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line = " ";
        for (std::size_t c = 0; c < row.size(); ++c)
            line += " " + row[c] + std::string(widths[c] - row[c].size() + 1, ' ');
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

/// Location of an effect as text, without the name of the scene file itself.
std::string location_text(const Location& where, const std::string& scene) {
    std::string text = where.text();
    if (!scene.empty() && text.starts_with(scene + ":")) return "line " + text.substr(scene.size() + 1);
    return text;
}

std::string effect_section(const EffectPlan& plan, const std::string& scene, bool on) {
    std::vector<Row> rows;
    for (const Effect& effect : plan.effects) {
        if (effect.on != on || effect.group == "never") continue;
        if (on)
            rows.push_back({effect.name, effect.bytes > 0 ? bytes_text(effect.bytes) : "-", effect.reason,
                            location_text(effect.where, scene)});
        else
            rows.push_back({effect.name, "0 bytes", effect.reason, location_text(effect.where, scene)});
    }
    return aligned(rows);
}

std::string never_line(const EffectPlan& plan) {
    std::string text;
    for (const Effect& effect : plan.effects)
        if (effect.group == "never") text += (text.empty() ? "" : ", ") + effect.name;
    return text;
}

/// "warning: " unless the text begins so already.
std::string warning_line(const std::string& text) {
    const std::string word = "warning: ";
    return (text.starts_with(word) ? "" : word) + text + "\n";
}

std::string memory_section(const char* whose, const std::vector<MemoryItem>& items, std::uint64_t total) {
    std::vector<Row> rows;
    rows.reserve(items.size());
    for (const MemoryItem& item : items)
        rows.push_back({item.name, bytes_text(item.bytes), item.formula});
    return std::string("\nmemory expected, ") + whose + ": " + bytes_text(total) + "\n" + aligned(rows);
}

/// Pass numbers, counted from 1 as in a render's messages.
std::string passes_text(const std::vector<std::uint32_t>& passes) {
    if (passes.size() == 1) return "pass " + std::to_string(passes[0] + 1);
    return "passes " + std::to_string(passes.front() + 1) + " to " + std::to_string(passes.back() + 1);
}

Json location_json(const Location& where) {
    if (where.file.empty()) return nullptr;
    return {{"file", where.file}, {"line", where.line}, {"column", where.column}};
}

Json memory_json(const std::vector<MemoryItem>& items, std::uint64_t total) {
    Json json = {{"bytes", total}, {"items", Json::array()}};
    for (const MemoryItem& item : items)
        json["items"].push_back({{"name", item.name}, {"bytes", item.bytes}, {"formula", item.formula}});
    return json;
}

}  // namespace

std::string bytes_text(std::uint64_t bytes) {
    if (bytes < 1024) return std::to_string(bytes) + " bytes";
    constexpr std::array units = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    double value = static_cast<double>(bytes) / 1024.0;
    std::size_t unit = 0;
    for (; value >= 1024.0 && unit + 1 < units.size(); ++unit)
        value /= 1024.0;
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), value < 10.0 ? "%.1f %s" : "%.0f %s", value, units[unit]);
    return text.data();
}

std::string approximation_text(const Approximation& approximation) {
    const std::string location = approximation.where.text();
    return approximation.effect + " is off for " + std::to_string(approximation.uses) +
           (approximation.uses == 1 ? " place" : " places") + " in the scene" +
           (location.empty() ? "" : " (" + location + ")") + ": " + approximation.text;
}

std::string plan_brief(const EffectPlan& plan, const std::string& scene) {
    std::string text = "plan of " + scene + ": " + std::to_string(plan.width) + " x " + std::to_string(plan.height) +
                       " pixels, " + (plan.passes_guessed ? "planned as for " : "") + std::to_string(plan.spp) +
                       " spp in " + std::to_string(plan.pass_count) + (plan.pass_count == 1 ? " pass, " : " passes, ") +
                       std::to_string(plan.triangles) + " triangles\n";
    if (!plan.advice.empty()) text += plan.advice + "\n";
    text += "memory expected: each worker " + bytes_text(plan.memory.worker_bytes()) + ", coordinator " +
            bytes_text(plan.memory.coordinator_bytes()) + "\n";
    for (const std::string& missed : plan.misses)
        text += "not found: " + missed + "\n";
    for (const Approximation& approximation : plan.approximations)
        text += "approximation: " + approximation_text(approximation) + "\n";
    for (const std::string& warning : plan.warnings)
        text += warning_line(warning);
    return text;
}

std::string plan_text(const EffectPlan& plan, const std::string& scene) {
    std::string text = plan_brief(plan, scene);
    text += memory_section("each worker", plan.memory.worker, plan.memory.worker_bytes());
    text += memory_section("coordinator", plan.memory.coordinator, plan.memory.coordinator_bytes());
    text += "\neffects on\n" + effect_section(plan, scene, true);
    text += "\neffects off\n" + effect_section(plan, scene, false);
    text += "\nnever simulated\n  " + never_line(plan) + "\n";
    std::vector<Row> kernels;
    for (const KernelUse& use : plan.kernels)
        kernels.push_back({use.kernel.name(), passes_text(use.passes)});
    text += kernels.empty() ? "\nestimator: " + plan.job.integrator.type + "\n" : "\nkernels\n" + aligned(kernels);
    return text;
}

std::string plan_json(const EffectPlan& plan, const std::string& scene) {
    Json json = {{"scene", scene},
                 {"width", plan.width},
                 {"height", plan.height},
                 {"spp", plan.spp},
                 {"passes", plan.pass_count},
                 {"passes_guessed", plan.passes_guessed},
                 {"triangles", plan.triangles}};
    json["effects"] = Json::array();
    for (const Effect& effect : plan.effects)
        json["effects"].push_back({{"name", effect.name},
                                   {"group", effect.group},
                                   {"simulated", effect.group != "never"},
                                   {"on", effect.on},
                                   {"reason", effect.reason},
                                   {"where", location_json(effect.where)},
                                   {"bytes", effect.bytes}});
    json["misses"] = plan.misses;
    if (!plan.advice.empty()) json["advice"] = plan.advice;
    json["approximations"] = Json::array();
    for (const Approximation& approximation : plan.approximations)
        json["approximations"].push_back({{"effect", approximation.effect},
                                          {"uses", approximation.uses},
                                          {"where", location_json(approximation.where)},
                                          {"text", approximation.text}});
    json["kernels_in_program"] = kKernelCount;
    json["kernels"] = Json::array();
    for (const KernelUse& use : plan.kernels)
        json["kernels"].push_back({{"name", use.kernel.name()}, {"passes", use.passes}});
    json["memory"] = {{"worker", memory_json(plan.memory.worker, plan.memory.worker_bytes())},
                      {"coordinator", memory_json(plan.memory.coordinator, plan.memory.coordinator_bytes())}};
    json["warnings"] = plan.warnings;
    // Paths need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace treefarm
