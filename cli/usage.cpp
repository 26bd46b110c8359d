// SPDX-License-Identifier: Apache-2.0
#include "cli/usage.h"

#include <algorithm>
#include <vector>

#include "common/base/text/parse_text.h"

namespace treefarm {

namespace {

/// Names of a command's options, as "--run-dir" and "-o", without those for help.
std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
        for (const std::string& name : option->get_snames())
            names.push_back("-" + name);
    }
    return names;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Command that was typed, or nullptr.
const CLI::App* typed_command(const CLI::App& app) {
    const auto typed = app.get_subcommands();
    return typed.empty() ? nullptr : typed.front();
}

std::string before_equals(const std::string& argument) {
    return argument.substr(0, argument.find('='));
}

bool looks_like_option(const std::string& argument) {
    return argument.size() > 1 && argument.front() == '-';
}

std::string nearest_option(const std::string& option, const CLI::App& command) {
    return nearest_word(option, option_names(command));
}

std::string unknown_option(const std::string& argument, const CLI::App& app, const CLI::App& command) {
    const std::string option = before_equals(argument);
    const std::string known = in_quotes(option).substr(1, in_quotes(option).size() - 2);
    const std::string text = known + " is no option of " + command.get_name() + "; ";
    const std::vector<std::string> own = option_names(command);
    if (std::find(own.begin(), own.end(), "-" + option) != own.end()) return text + "did you mean -" + option + "?";
    if (const std::string advice = option_advice(option, command.get_name()); !advice.empty()) return text + advice;
    if (const std::string nearest = nearest_option(option, command); !nearest.empty())
        return text + "did you mean " + nearest + "?";
    for (const CLI::App* other : commands_of(app)) {
        const auto names = option_names(*other);
        if (std::find(names.begin(), names.end(), option) != names.end())
            return text + "it is one of treefarm " + other->get_name();
    }
    return text + "see treefarm " + command.get_name() + " --help";
}

/// Name of a command's only input file.
std::string input_of(const CLI::App& command) {
    const std::string& name = command.get_name();
    if (name == "render" || name == "plan") return "a scene (.xml) or a job (.toml)";
    if (name == "check") return "a scene (.xml)";
    if (name == "study") return "a study file (.toml)";
    if (name == "report") return "the folder of a study";
    if (name == "serve") return "a run directory, or a folder that holds some";
    if (name == "launch") return "a command behind --";
    if (name == "inspect") return "the run directory of a guided render";
    if (name == "compare") return "an image and a reference (.exr)";
    return "fewer words";
}

std::string left_over(const std::vector<std::string>& arguments, const CLI::App& app, const CLI::App& command) {
    const auto option = std::find_if(arguments.begin(), arguments.end(), &looks_like_option);
    if (option != arguments.end()) return unknown_option(*option, app, command);
    std::string words;
    for (const std::string& word : arguments)
        words += (words.empty() ? "" : ", ") + in_quotes(word);
    return words + (arguments.size() == 1 ? " is" : " are") + " more than " + command.get_name() + " takes, " +
           input_of(command) + "; start it once for each, and put a value with blanks in quotes";
}

/// Number of times that an option was typed.
std::ptrdiff_t count_of(const std::string& option, std::span<const std::string> arguments) {
    return std::count_if(arguments.begin(), arguments.end(),
                         [&](const std::string& argument) { return before_equals(argument) == option; });
}

/// Option of a parser's message like "--spp: 1 required TEXT missing".
std::string option_of(const std::string& what) {
    return what.substr(0, what.find(':'));
}

/// Number of times that an option was typed by any name: the parser's messages use the last of "-o,--output".
std::ptrdiff_t count_of_any_name(const std::string& name, const CLI::App& command,
                                 std::span<const std::string> arguments) {
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) return count_of(name, arguments);
    std::ptrdiff_t count = 0;
    for (const std::string& long_name : option->get_lnames())
        count += count_of("--" + long_name, arguments);
    for (const std::string& short_name : option->get_snames())
        count += count_of("-" + short_name, arguments);
    return count;
}

}  // namespace

std::string unknown_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> commands;
    for (const CLI::App* command : commands_of(app))
        commands.push_back(command->get_name());
    if (std::find(commands.begin(), commands.end(), word) != commands.end()) return "";
    if (looks_like_option(word)) {
        const auto own = option_names(app);
        if (std::find(own.begin(), own.end(), word) != own.end()) return "";
        return word + " stands before the command; write treefarm COMMAND ..., see treefarm --help";
    }
    if (word.ends_with(".xml") || word.ends_with(".toml"))
        return in_quotes(word) + " is a file, not a command; write treefarm render " + word;
    const std::string nearest = nearest_word(word, commands);
    return "no command is called " + in_quotes(word) + "; " +
           (nearest.empty() ? "see treefarm --help" : "did you mean " + in_quotes(nearest) + "?");
}

std::string malformed_argument(std::span<const std::string> arguments) {
    for (const std::string& argument : arguments) {
        if (argument == "--") break;
        if (argument.size() > 3 && argument.starts_with("--") && argument.find('=') == argument.size() - 1)
            return argument + " has no value behind \"=\"; give one, or leave " + before_equals(argument) + " away";
    }
    return "";
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error, std::span<const std::string> arguments) {
    const CLI::App* command = typed_command(app);
    if (command == nullptr)
        return app.remaining().empty() ? "no command was given; see treefarm --help"
                                       : unknown_option(app.remaining().front(), app, app);
    // Even beside another error: a misspelled option may be the reason for a missing input.
    if (const std::vector<std::string> extra = command->remaining(); !extra.empty())
        return left_over(extra, app, *command);
    const std::string help = "see treefarm " + command->get_name() + " --help";
    const std::string what = error.what();
    if (error.get_name() == "RequiredError") return command->get_name() + " needs " + input_of(*command) + "; " + help;
    if (error.get_name() == "ArgumentMismatch") {
        const std::string option = option_of(what);
        return option + (count_of_any_name(option, *command, arguments) > 1 ? " is given more than once; give it once"
                                                                            : " has no value; " + help);
    }
    if (error.get_name() == "ConversionError" || error.get_name() == "InvalidError")
        for (const std::string& argument : arguments)
            if (argument.starts_with("--") && argument.find('=') != std::string::npos)
                return before_equals(argument) + " takes no value; leave " +
                       in_quotes(argument.substr(argument.find('='))) + " away";
    return what + "; " + help;
}

}  // namespace treefarm
