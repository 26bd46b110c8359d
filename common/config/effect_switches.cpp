// SPDX-License-Identifier: Apache-2.0
#include "common/config/effect_switches.h"

#include <algorithm>
#include <vector>

#include "common/config/effects/table.h"

namespace treefarm {

std::span<const EffectSwitch> effect_switches() {
    static const std::vector<EffectSwitch> switches = [] {
        std::vector<std::pair<int, EffectSwitch>> by_step;
        for_each_effect([&](const auto& row) {
            if constexpr (kHasSwitch<decltype(row.off)>)
                by_step.push_back({row.off.step, {row.text.name, row.off.replacement}});
        });
        std::sort(by_step.begin(), by_step.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<EffectSwitch> sorted;
        sorted.reserve(by_step.size());
        for (auto& [step, effect] : by_step)
            sorted.push_back(std::move(effect));
        return sorted;
    }();
    return switches;
}

std::span<const std::pair<std::string, std::string>> effects_without_switch() {
    static const std::vector<std::pair<std::string, std::string>> effects = [] {
        std::vector<std::pair<std::string, std::string>> cures;
        for_each_effect([&](const auto& row) {
            if constexpr (requires { row.off.cure; }) cures.emplace_back(row.text.name, row.off.cure);
            if constexpr (requires { row.off.whole; })
                cures.emplace_back(row.text.name, std::string("switch off ") + kEffectsPrefix + row.off.whole);
        });
        return cures;
    }();
    return effects;
}

}  // namespace treefarm
