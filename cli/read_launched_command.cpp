// SPDX-License-Identifier: Apache-2.0
#include "cli/read_launched_command.h"

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/render.h"
#include "cli/usage.h"
#include "common/base/refuse.h"
#include "common/config/job_reader.h"
#include "coordinator/render/resume.h"
#include "coordinator/study/study.h"

namespace treefarm {

namespace {

using Words = std::vector<std::string>;

/// Last value of an option; "" if it is absent.
std::string value_of(const CLI::App& command, const std::string& option) {
    const Words values = command.get_option(option)->results();
    return values.empty() ? "" : values.back();
}

/// Value of a setting, "" if it is absent; the last one counts.
std::string value_of(const std::vector<Setting>& settings, const std::string& key) {
    std::string value;
    for (const Setting& setting : settings)
        if (setting.key == key) value = setting.value;
    return value;
}

Words farm_options(const CLI::App& command) {
    Words words;
    for (const char* option : {"--threads", "--start-seconds"})
        if (const std::string value = value_of(command, option); !value.empty())
            words.insert(words.end(), {option, value});
    for (const char* flag : {"--quiet", "--verbose"})
        if (command.get_option(flag)->count() > 0) words.emplace_back(flag);
    return words;
}

void read_render(const CLI::App& command, LaunchedCommand& launched) {
    if (command.get_option("--debug-sample")->count() > 0)
        refuse("launch", "--debug-sample traces one sample in one process", "leave launch away");
    RenderOptions options;
    options.input = value_of(command, "input");
    options.run_directory = value_of(command, "--run-dir");
    if (command.get_option("--frames")->count() > 0) {
        launched.kind = LaunchedCommand::Kind::shot;
        launched.folder = shot_directory(options);
        return;
    }
    std::vector<Setting> settings;
    if (options.input.ends_with(".toml")) settings = read_job_settings(options.input);
    for (const std::string& argument : command.get_option("--set")->results())
        settings.push_back(parse_set_argument(argument));
    launched.scene = options.input.ends_with(".toml") ? value_of(settings, "scene.file") : options.input;
    launched.folder = options.run_directory.empty() ? value_of(settings, "output.directory") : options.run_directory;
    launched.farm_options = farm_options(command);
    launched.goes_on = command.get_option("--resume")->count() > 0;
}

void read_resume(const CLI::App& command, LaunchedCommand& launched) {
    launched.kind = LaunchedCommand::Kind::resume;
    launched.folder = value_of(command, "run");
    check_run_folder(launched.folder);
}

void read_study_command(const CLI::App& command, LaunchedCommand& launched) {
    if (command.get_option("--dry-run")->count() > 0)
        refuse("launch", "--dry-run renders nothing", "leave launch away");
    launched.kind = LaunchedCommand::Kind::study;
    const std::string folder = value_of(command, "--dir");
    launched.folder = folder.empty() ? read_study(value_of(command, "input")).directory : folder;
}

/// Exception that leaves the parser after all options are checked, before the command runs.
struct Checked {};

/// Adds the commands that can be launched.
void add_commands(CLI::App& app, int& no_code) {
    const LaunchEnvironment nowhere;
    add_render_command(app, nowhere, "", no_code);
    add_resume_command(app, nowhere, "", no_code);
    add_study_command(app, nowhere, "", no_code);
    app.parse_complete_callback([] { throw Checked(); });
}

}  // namespace

LaunchedCommand read_launched_command(const Words& words) {
    if (words.empty()) refuse("launch", "has nothing to launch", "write treefarm launch -n 3 -- render scene.xml");
    int no_code = 0;
    CLI::App app("", "treefarm");
    app.require_subcommand(1);
    add_commands(app, no_code);
    if (const std::string& name = words.front(); name != "render" && name != "resume" && name != "study")
        refuse("launch", "\"" + words.front() + "\" cannot be launched", "name render, resume or study behind --");
    if (const std::string message = malformed_argument(words); !message.empty()) refuse("launch", message, "");
    try {
        Words reversed(words.rbegin(), words.rend());
        app.parse(reversed);
    } catch (const Checked&) {
    } catch (const CLI::Success&) {
        refuse("launch", "asks for help or a version, which is no render", "treefarm " + words.front() + " --help");
    } catch (const CLI::ParseError& error) {
        refuse("launch", usage_message(app, error, words), "");
    }
    LaunchedCommand launched;
    launched.words = words;
    const CLI::App& command = *app.get_subcommands().front();
    if (words.front() == "render")
        read_render(command, launched);
    else if (words.front() == "resume")
        read_resume(command, launched);
    else
        read_study_command(command, launched);
    return launched;
}

}  // namespace treefarm
