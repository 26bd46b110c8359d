// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/setting.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns properties of an integrator into settings of the job.
class IntegratorSettings {
  public:
    IntegratorSettings(Properties& properties, std::vector<Setting>& settings, Diagnostics& diagnostics)
        : properties_(properties), settings_(settings), diagnostics_(diagnostics) {}

    Properties& properties() { return properties_; }
    Diagnostics& diagnostics() { return diagnostics_; }

    void set(const std::string& key, const std::string& value, const Location& where) {
        settings_.push_back({key, value, where});
    }
    /// Sets a key, at the location of the property `name`.
    void set_by(const char* name, const std::string& key, const std::string& value) {
        set(key, value, properties_.where(name));
    }

    /// Adds to the list of layers that the scene requests; `list` is comma-separated.
    void add_aovs(const std::string& list, const Location& where) { add_aovs(settings_, list, where); }
    static void add_aovs(std::vector<Setting>& settings, const std::string& list, const Location& where);

    void read_integer(const char* name, const char* key);
    void read_number(const char* name, const char* key);
    void read_boolean(const char* name, const char* key);
    /// Reads a property with one of several words; each maps to a value of the key. Other words throw InputError.
    void read_words(const char* name, const char* key, const std::vector<std::pair<std::string, std::string>>& words);

    /// Reads the properties of every integrator: length of paths, strict normals, hidden emitters.
    void read_common();
    /// Reads strict normals and hidden emitters alone.
    void read_flags();

  private:
    Properties& properties_;
    std::vector<Setting>& settings_;
    Diagnostics& diagnostics_;
};

/// Turns <integrator type="guided_path"> (the plugin of Mueller et al., 2017 to 2019) into settings of the job: the
/// preset paper, overridden by the element's properties.
void read_guided_path(IntegratorSettings& settings);

}  // namespace treefarm::mitsuba
