// SPDX-License-Identifier: Apache-2.0
#include "report/effect_costs.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/read_bytes.h"
#include "common/runs/run_files.h"
#include "report/figure_text.h"
#include "report/html.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

const std::string kPrefix = "effects.";

/// The one effect that is off in `off` and on in `with`, all else being equal; empty if they differ otherwise.
std::string only_effect_off(const MethodResult& with, const MethodResult& off) {
    std::string effect;
    for (const auto& [key, value] : off.settings) {
        const auto at = with.settings.find(key);
        if (at != with.settings.end() && at->second == value) continue;
        const bool one = effect.empty() && at == with.settings.end() && key.starts_with(kPrefix) && value == "false";
        if (!one) return "";
        effect = key.substr(kPrefix.size());
    }
    return off.settings.size() == with.settings.size() + 1 ? effect : "";
}

Interval ratio_of_core_seconds(const std::vector<const CellResult*>& with, const std::vector<const CellResult*>& off) {
    std::vector<double> a, b;
    for (const CellResult* one : with)
        for (const CellResult* other : off)
            if (one->repetition == other->repetition) {
                a.push_back(one->passes.back().core_seconds);
                b.push_back(other->passes.back().core_seconds);
            }
    return geometric_ratio(a, b);
}

/// Costs of a method's effects, by name.
std::map<std::string, std::string> costs_of(const std::vector<EffectCost>& costs, const std::string& method) {
    std::map<std::string, std::string> texts;
    for (const EffectCost& cost : costs) {
        if (cost.with == method) texts[cost.effect] = "&times;" + interval_text(cost.core_seconds);
        if (cost.off == method) texts[cost.effect] = "off: saves &times;" + interval_text(cost.core_seconds);
    }
    return texts;
}

std::string memory_text(double bytes) {
    if (bytes < 1024) return fmt::format("{:.0f} bytes", bytes);
    return bytes < 1024 * 1024 ? fmt::format("{:.3g} KiB", bytes / 1024) : fmt::format("{:.3g} MiB", bytes / 1048576);
}

std::string plan_table(const Json& plan, const std::map<std::string, std::string>& costs) {
    std::vector<std::vector<std::string>> rows = {{"effect", "simulated", "memory", "core-seconds", "why"}};
    for (const Json& effect : plan.at("effects")) {
        const std::string name = effect.at("name");
        const auto cost = costs.find(name);
        rows.push_back({html_text(name), effect.at("on").get<bool>() ? "yes" : "no",
                        effect.at("on").get<bool>() ? memory_text(effect.at("bytes").get<double>()) : "",
                        cost == costs.end() ? "" : cost->second, html_text(effect.at("reason").get<std::string>())});
    }
    return html_table(rows);
}

}  // namespace

std::vector<EffectCost> effect_costs(const StudyResults& results, const SceneResult& scene) {
    std::vector<EffectCost> costs;
    for (const MethodResult& with : results.methods)
        for (const MethodResult& off : results.methods) {
            const std::string effect = only_effect_off(with, off);
            if (effect.empty()) continue;
            const Interval ratio =
                ratio_of_core_seconds(results.of(scene.name, with.name), results.of(scene.name, off.name));
            if (std::isfinite(ratio.mean)) costs.push_back({effect, with.name, off.name, ratio});
        }
    return costs;
}

std::string plan_tables(const StudyResults& results, const SceneResult& scene) {
    const std::vector<EffectCost> costs = effect_costs(results, scene);
    struct Plan {
        std::string text, names;
        std::map<std::string, std::string> costs;
    };
    std::vector<Plan> plans;
    for (const MethodResult& method : results.methods) {
        const auto cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        Plan plan{read_text(cells.front()->folder / kPlanFile), method.name, costs_of(costs, method.name)};
        const auto same = std::find_if(plans.begin(), plans.end(),
                                       [&](const Plan& p) { return p.text == plan.text && p.costs == plan.costs; });
        if (same == plans.end())
            plans.push_back(std::move(plan));
        else
            same->names += ", " + method.name;
    }
    std::string html;
    for (const Plan& plan : plans) {
        const Json json = Json::parse(plan.text, nullptr, false);
        if (json.is_discarded()) continue;
        html += std::string("<details") + (html.empty() ? " open" : "") + "><summary>" + html_text(plan.names) +
                "</summary>\n" + plan_table(json, plan.costs) + "</details>\n";
    }
    return html;
}

}  // namespace treefarm
