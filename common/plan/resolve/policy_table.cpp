// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/policy_table.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "common/base/text/parse_text.h"
#include "common/decide/decisions.h"

namespace treefarm {
namespace {

/// Constants that earlier builds recorded in resolved.toml, with their present values. After a change of one that
/// images depend on, kResults must be raised.
constexpr std::string_view kUnrecorded =
    " next_event.least_rest=0.02 levels.block=8 light_subpaths.prior_paths=128 light_subpaths.unlearned=0.2 "
    "walk.split_least=0.00024414062 learning.kept_evidence=0.5 grids.halvings=12 grids.table_halvings=15 "
    "grids.even_part=0.1 grids.table_floor=0.02 lights.least_cut=0.03125 lights.few_triangles=16 "
    "lights.small_share=0.015625 lights.least_area=0.001 lights.far_lanes=4 splats.nearest=1.52587890625e-05 "
    "splats.alike=16 schedule.guessed_spp=64 schedule.samples_per_unit=262144 farm.half_life=2 "
    "farm.most_seconds=2 farm.part=0.25 farm.copy_gain=0.1 farm.copy_ratio=1 budget.least_left=0.25 "
    "budget.worth_hedging=0.5 budget.most_late=0.75 tails.outlier=0.25 tails.noise_part=0.4 "
    "tails.told_share=0.001 tails.least_pixels=4096 ";

/// Value of a constant in kUnrecorded; "" if it is not listed.
std::string_view unrecorded(const std::string& name) {
    const std::size_t at = kUnrecorded.find(" " + name + "=");
    if (at == kUnrecorded.npos) return "";
    const std::string_view value = kUnrecorded.substr(at + name.size() + 2);
    return value.substr(0, value.find(' '));
}

}  // namespace

std::vector<policy::Constant> tuned_constants() {
    std::vector<policy::Constant> all;
    for (const std::span<const policy::Constant> table : Decisions::constants())
        all.insert(all.end(), table.begin(), table.end());
    all.insert(all.end(), std::begin(policy::kConstants), std::end(policy::kConstants));
    return all;
}

std::string write_policy() {
    std::string text, section;
    for (const policy::Constant& constant : tuned_constants()) {
        const std::string name = constant.name, head = name.substr(0, name.find('.'));
        if (head != section) text += (text.empty() ? "[policy." : "\n[policy.") + head + "]\n";
        section = head;
        text += name.substr(head.size() + 1) + " = " + number_text(constant.value) + "\n";
    }
    return text;
}

void check_policy(std::span<const Setting> settings, const Location& file) {
    const auto require = [](const Setting& written, std::string_view value) {
        if (written.value != value)
            throw InputError(
                written.where,
                written.key + " was " + written.value + ", and is " + std::string(value) + " in this build",
                kResolvedCure);
    };
    const std::vector<policy::Constant> constants = tuned_constants();
    std::vector<std::string> known;
    for (const policy::Constant& constant : constants)
        known.push_back(std::string(kPolicyPrefix) + constant.name);
    for (const Setting& setting : settings) {
        if (!setting.key.starts_with(kPolicyPrefix) ||
            std::find(known.begin(), known.end(), setting.key) != known.end())
            continue;
        const std::string_view value = unrecorded(setting.key.substr(kPolicyPrefix.size()));
        if (value.empty()) {
            const std::string nearest = nearest_word(setting.key, known);
            throw InputError(setting.where, setting.key + " is no constant of this build",
                             (nearest.empty() ? "" : "did you mean " + nearest + "? Otherwise ") + kResolvedCure);
        }
        require(setting, value);
    }
    for (std::size_t i = 0; i < known.size(); ++i) {
        const auto written =
            std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == known[i]; });
        if (written == settings.end())
            throw InputError(
                file, known[i] + " is not in it: the build that wrote it had no such constant, or it was taken out",
                kResolvedCure);
        require(*written, number_text(constants[i].value));
    }
}

std::string policy_documentation() {
    std::string text = "| constant | value | meaning | work at half, at twice | evidence |\n|---|---|---|---|---|\n";
    for (const policy::Constant& constant : tuned_constants())
        text += std::string("| `") + constant.name + "` | " + number_text(constant.value) + " | " + constant.meaning +
                " | " + constant.sensitivity + " | " + constant.evidence + " |\n";
    return text;
}

}  // namespace treefarm
