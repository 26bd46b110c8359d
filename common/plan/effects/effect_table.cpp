// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/effect_table.h"

#include <vector>

#include "common/config/effect_switches.h"
#include "common/config/effects/table.h"

namespace treefarm {
namespace {

std::string switch_text(const EffectDescription& effect) {
    for (const EffectSwitch& known : effect_switches())
        if (known.name == effect.name) return "`effects." + effect.name + " = false`: " + known.replacement;
    for (const auto& [name, cure] : effects_without_switch())
        if (name == effect.name) return cure;
    return "";
}

std::string with_parts(std::string when, const char* name) {
    if (const std::size_t star = when.find('*'); star != std::string::npos) when.replace(star, 1, names_of_parts(name));
    return when;
}

}  // namespace

std::span<const EffectDescription> effect_table() {
    static const std::vector<EffectDescription> table = [] {
        std::vector<EffectDescription> rows;
        for_each_effect([&](const auto& row) {
            const EffectText& text = row.text;
            rows.push_back({text.name, text.group, text.what, with_parts(text.when, text.name), text.cost,
                            std::string_view(text.group) != kNeverGroup});
        });
        return rows;
    }();
    return table;
}

std::string names_of_parts(std::string_view whole) {
    std::vector<std::string> names;
    for_each_effect([&](const auto& row) {
        if constexpr (requires { row.off.whole; })
            if (whole == row.off.whole) names.push_back(row.text.name);
    });
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return text;
}

std::string effect_documentation() {
    std::string text = "| effect | what it is | on when | cost | off by |\n|---|---|---|---|---|\n";
    for (const EffectDescription& effect : effect_table())
        if (effect.simulated)
            text += "| `" + effect.name + "` | " + effect.what + " | " + effect.when + " | " + effect.cost + " | " +
                    switch_text(effect) + " |\n";
    text += "\nNever simulated:\n\n";
    for (const EffectDescription& effect : effect_table())
        if (!effect.simulated) text += "- `" + effect.name + "`: " + effect.what + "\n";
    return text;
}

}  // namespace treefarm
