// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study_rules.h"

#include <string_view>

#include "common/base/text/parse_text.h"

namespace treefarm {
namespace {

/// Prefix of keys that a part of the study may not set, and what to do instead.
struct Reserved {
    std::string_view beginning;
    const char* cure;
};
constexpr Reserved kEverywhere[] = {{"output.", "results go into the study's directory"},
                                    {"scene.file", "write it as file in [scene.NAME]"}};
constexpr Reserved kOfSeeds = {"sampler.seed", "write seeds = [...] at the top of the study"};
constexpr Reserved kOfBudget[] = {{"budget.spp", "it stands in [budget], the same for all cells"},
                                  {"budget.seconds", "it stands in [budget], the same for all cells"},
                                  {"budget.error", "it stands in [budget], the same for all cells"}};
constexpr Reserved kOfScenes[] = {
    {"scene.", "a scene is read once for all methods: write it in [scene.NAME] or [job]"},
    {"image.", "images of one scene must have one size: write it in [scene.NAME] or [job]"}};

void refuse(const Setting& setting, const Reserved& reserved) {
    if (setting.key.starts_with(reserved.beginning))
        throw InputError(setting.where, setting.key + " has another place in a study", reserved.cure);
}

}  // namespace

void check_study_key(const Setting& setting, StudyPart part) {
    for (const Reserved& reserved : kEverywhere)
        refuse(setting, reserved);
    if (part != StudyPart::reference) {
        refuse(setting, kOfSeeds);
        for (const Reserved& reserved : kOfBudget)
            refuse(setting, reserved);
    }
    if (part == StudyPart::method || part == StudyPart::reference)
        for (const Reserved& reserved : kOfScenes)
            refuse(setting, reserved);
}

void check_study_name(const std::string& name, const Location& where) {
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_- +=.";
    if (name.empty() || name.size() > 60 || name.find_first_not_of(allowed) != std::string::npos)
        throw InputError(where, in_quotes(name) + " cannot be a name",
                         "use up to 60 letters, digits, blanks and _ - + = .");
}

}  // namespace treefarm
