// SPDX-License-Identifier: Apache-2.0
#include "cli/option_values.h"

#include <cmath>

#include "common/base/error.h"
#include "common/base/text/parse_text.h"
#include "common/config/quantities.h"

namespace treefarm {

namespace {

constexpr NumberRange kSamples{1, 1u << 30, "samples per pixel", "64"};
constexpr NumberRange kThreads{1, 4096, "threads", "4"};

std::string text_of(double number) {
    return std::floor(number) == number && std::abs(number) < 1e15 ? std::to_string(static_cast<std::int64_t>(number))
                                                                   : number_text(number);
}

/// Example of an option as typed: "--spp 64", "--output x.exr".
std::string typed(const std::string& option, const std::string& example) {
    return option + " " + example;
}

[[noreturn]] void refuse_value(const std::string& option, const std::string& what, const std::string& cure) {
    throw InputError(Location{option, 0, 0}, what, cure);
}

/// Reason why a text is no number; "nan" is none, either.
std::string not_a_number(const std::string& text) {
    return trim(text).empty() ? "the value is empty" : in_quotes(text) + " is not a number";
}

std::string range_cure(const std::string& option, const NumberRange& range, const char* kind) {
    return std::string("give ") + kind + range.meaning + " from " + text_of(range.low) + " to " + text_of(range.high) +
           ", for instance " + typed(option, range.example);
}

double within(const std::string& option, const std::string& text, const NumberRange& range, const char* kind) {
    const auto number = parse_number(text);
    const std::string cure = range_cure(option, range, kind);
    if (!number) refuse_value(option, not_a_number(text), cure);
    if (*number < range.low) refuse_value(option, in_quotes(text) + " is less than " + text_of(range.low), cure);
    if (*number > range.high) refuse_value(option, in_quotes(text) + " is more than " + text_of(range.high), cure);
    return *number;
}

/// Checks the value of a text option as -o: not empty, and not the next option.
void check_text(const std::string& option, const std::string& text) {
    if (text.empty()) refuse_value(option, "the value is empty", "give one, or leave " + option + " away");
    if (text.starts_with("--"))
        refuse_value(option, "no value before " + text,
                     "give one, or leave " + option + " away; a name that begins so: ./" + text);
    if (text.front() == '=' && !option.starts_with("--"))
        refuse_value(option, "its value would begin with \"=\"", "write " + typed(option, text.substr(1)));
}

/// First name of "-o,--output", for messages.
std::string first_name(const std::string& names) {
    return names.substr(0, names.find(','));
}

}  // namespace

double checked_number(const std::string& option, const std::string& text, const NumberRange& range) {
    return within(option, text, range, "");
}

std::int64_t checked_integer(const std::string& option, const std::string& text, const NumberRange& range) {
    const double number = within(option, text, range, "whole ");
    if (const auto integer = parse_integer(text)) return *integer;
    if (std::floor(number) == number)
        refuse_value(option, in_quotes(text) + " is not written in digits alone",
                     "write " + typed(option, text_of(number)));
    refuse_value(option, in_quotes(text) + " is not a whole number", range_cure(option, range, "whole "));
}

std::uint32_t checked_samples(const std::string& text) {
    return static_cast<std::uint32_t>(checked_integer("--spp", text, kSamples));
}

double checked_seconds(const std::string& option, const std::string& text) {
    const std::string cure =
        "give seconds, or a number with a unit (s, min, h): " + typed(option, "90") + ", " + typed(option, "2min");
    const auto seconds = parse_duration(text);
    if (!seconds)
        refuse_value(option, trim(text).empty() ? "the value is empty" : in_quotes(text) + " is no time", cure);
    if (*seconds == 0) refuse_value(option, "in 0 seconds nothing is rendered", cure);
    if (*seconds < kLeastSeconds)
        refuse_value(option, in_quotes(text) + " is less than a thousandth of a second", cure);
    if (*seconds > kMostSeconds)
        refuse_value(option, in_quotes(text) + " is more than 10^8 seconds, three years", cure);
    return *seconds;
}

double checked_error(const std::string& text) {
    const std::string cure = "give a fraction of the mean, or a percentage: --error 0.05 or --error 5%";
    const auto error = parse_fraction(text);
    if (!error) refuse_value("--error", not_a_number(text), cure);
    if (*error == 0) refuse_value("--error", "an error of 0 takes forever", cure);
    if (*error < 0) refuse_value("--error", in_quotes(text) + " is negative", cure);
    if (*error < kLeastError)
        refuse_value("--error", in_quotes(text) + " is less than 10^-6, which takes forever", cure);
    if (*error > kGreatestError) {
        const bool percent = text.find('%') == std::string::npos && *error <= 100;
        refuse_value(
            "--error",
            in_quotes(text) + " is " + text_of(100 * *error) + " % of the mean, and a black image is as good as 100 %",
            percent ? "for " + text_of(*error) + " % write --error " + number_text(*error / 100) + " or --error " +
                          text_of(*error) + "%"
                    : cure);
    }
    return *error;
}

unsigned checked_threads(const std::string& text) {
    return static_cast<unsigned>(checked_integer("--threads", text, kThreads));
}

CLI::Option* add_text_option(CLI::App& command, const std::string& names, std::string& value, const std::string& help) {
    return command.add_option_function<std::string>(
        names,
        [&value, option = first_name(names)](const std::string& text) {
            check_text(option, text);
            value = text;
        },
        help);
}

CLI::Option* add_texts_option(CLI::App& command, const std::string& names, std::vector<std::string>& values,
                              const std::string& help) {
    return command
        .add_option_function<std::vector<std::string>>(
            names,
            [&values, option = first_name(names)](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    check_text(option, text);
                values = texts;
            },
            help)
        ->allow_extra_args(false);
}

CLI::Option* add_samples_option(CLI::App& command, std::optional<std::uint32_t>& spp, const std::string& help) {
    return command
        .add_option_function<std::string>(
            "--spp", [&spp](const std::string& text) { spp = checked_samples(text); }, help)
        ->type_name("N");
}

CLI::Option* add_seconds_option(CLI::App& command, const std::string& name, std::optional<double>& seconds,
                                const std::string& help) {
    return command
        .add_option_function<std::string>(
            name, [&seconds, name](const std::string& text) { seconds = checked_seconds(name, text); }, help)
        ->type_name("TIME");
}

CLI::Option* add_error_option(CLI::App& command, std::optional<double>& error, const std::string& help) {
    return command
        .add_option_function<std::string>(
            "--error", [&error](const std::string& text) { error = checked_error(text); }, help)
        ->type_name("SHARE");
}

CLI::Option* add_threads_option(CLI::App& command, unsigned& threads, const std::string& help) {
    return command
        .add_option_function<std::string>(
            "--threads", [&threads](const std::string& text) { threads = checked_threads(text); }, help)
        ->type_name("N");
}

CLI::Option* add_display_option(CLI::App& command, std::string& server) {
    return add_text_option(command, "--display-server", server,
                           "HOST:PORT of a viewer that speaks tev's protocol: it shows the image while it renders")
        ->type_name("HOST:PORT");
}

CLI::Option* add_number_option(CLI::App& command, const std::string& name, double& value, const NumberRange& range,
                               const std::string& help) {
    return command
        .add_option_function<std::string>(
            name, [&value, name, range](const std::string& text) { value = checked_number(name, text, range); }, help)
        ->type_name("X");
}

}  // namespace treefarm
