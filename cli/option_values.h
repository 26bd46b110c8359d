// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treefarm {

// Options whose values are checked while parsing. A bad value leaves CLI::App::parse as an InputError that names the
// option, the value, the reason and a valid example.

/// Exit codes, for the end of a command's help.
inline constexpr const char* kExitCodesText =
    "Exit codes: 0 done, 1 the run failed, 2 bad usage or input, 3 interrupted, 4 done, but --error was not reached,\n"
    "5 check found something";
inline constexpr const char* kDefaultsText =
    "Settings come from the scene, a job, --set and the options above, later ones over earlier ones; treefarm keys "
    "lists\n"
    "them with their defaults, and the run directory's job.toml has the ones used";

/// Allowed numbers of an option, with texts for messages.
struct NumberRange {
    double low = 0, high = 0;
    const char* meaning = "";  ///< "samples per pixel"
    const char* example = "";  ///< "64"
};

/// Number within the range; throws InputError.
double checked_number(const std::string& option, const std::string& text, const NumberRange& range);
/// Whole number within the range (at most 2^53); throws InputError.
std::int64_t checked_integer(const std::string& option, const std::string& text, const NumberRange& range);

/// Value of --spp
std::uint32_t checked_samples(const std::string& text);
/// Value of --seconds and similar options; may have a unit (s, min, h)
double checked_seconds(const std::string& option, const std::string& text);
/// Value of --error; may be in percent
double checked_error(const std::string& text);
/// Value of --threads
unsigned checked_threads(const std::string& text);

/// Adds an option for a file or folder name, or another text that cannot be empty.
CLI::Option* add_text_option(CLI::App& command, const std::string& names, std::string& value, const std::string& help);
/// Adds a text option that may be repeated: --set a=1 --set b=2.
CLI::Option* add_texts_option(CLI::App& command, const std::string& names, std::vector<std::string>& values,
                              const std::string& help);

CLI::Option* add_samples_option(CLI::App& command, std::optional<std::uint32_t>& spp, const std::string& help);
CLI::Option* add_seconds_option(CLI::App& command, const std::string& name, std::optional<double>& seconds,
                                const std::string& help);
CLI::Option* add_error_option(CLI::App& command, std::optional<double>& error, const std::string& help);
CLI::Option* add_threads_option(CLI::App& command, unsigned& threads, const std::string& help);
/// Adds --display-server
CLI::Option* add_display_option(CLI::App& command, std::string& server);

/// Adds an option whose value is a whole number within `range`.
template <class T>
CLI::Option* add_integer_option(CLI::App& command, const std::string& name, T& value, const NumberRange& range,
                                const std::string& help) {
    return command
        .add_option_function<std::string>(
            name,
            [&value, name, range](const std::string& text) {
                value = static_cast<T>(checked_integer(name, text, range));
            },
            help)
        ->type_name("N");
}

/// Adds an option whose value is a number within `range`.
CLI::Option* add_number_option(CLI::App& command, const std::string& name, double& value, const NumberRange& range,
                               const std::string& help);

}  // namespace treefarm
