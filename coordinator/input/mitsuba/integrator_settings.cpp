// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/integrator_settings.h"

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {

void IntegratorSettings::add_aovs(std::vector<Setting>& settings, const std::string& list, const Location& where) {
    if (list.empty()) return;
    for (Setting& setting : settings)
        if (setting.key == "output.aovs") {
            setting.value += "," + list;
            return;
        }
    settings.push_back({"output.aovs", list, where});
}

void IntegratorSettings::read_integer(const char* name, const char* key) {
    const std::int64_t value = properties_.integer(name, 0);
    if (properties_.has(name)) set_by(name, key, std::to_string(value));
}

void IntegratorSettings::read_number(const char* name, const char* key) {
    const double value = properties_.number(name, 0.0);
    if (properties_.has(name)) set_by(name, key, number_text(value));
}

void IntegratorSettings::read_boolean(const char* name, const char* key) {
    const bool value = properties_.boolean(name, false);
    if (properties_.has(name)) set_by(name, key, value ? "true" : "false");
}

void IntegratorSettings::read_words(const char* name, const char* key,
                                    const std::vector<std::pair<std::string, std::string>>& words) {
    const std::string value = properties_.text(name, "");
    if (!properties_.has(name)) return;
    std::string allowed;
    for (const auto& [word, translated] : words) {
        if (word == value) return set_by(name, key, translated);
        allowed += (allowed.empty() ? "" : " or ") + word;
    }
    throw InputError(properties_.where(name), "unknown value " + in_quotes(value) + " of " + name, "use " + allowed);
}

void IntegratorSettings::read_common() {
    read_integer("max_depth", "integrator.max_depth");
    read_integer("rr_depth", "integrator.rr_depth");
    read_flags();
}

void IntegratorSettings::read_flags() {
    properties_.ignore({"block_size", "samples_per_pass", "timeout"});
    read_boolean("strict_normals", "integrator.strict_normals");
    read_boolean("hide_emitters", "integrator.hide_emitters");
}

}  // namespace treefarm::mitsuba
