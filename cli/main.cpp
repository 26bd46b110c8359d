#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "cli/check.h"
#include "cli/compare.h"
#include "cli/inspect.h"
#include "cli/launch.h"
#include "cli/plan.h"
#include "cli/render.h"
#include "cli/study.h"
#include "cli/this_build.h"
#include "common/base/error.h"
#include "common/base/float_traps.h"
#include "common/config/parse_text.h"

namespace treefarm {

namespace {

std::string joined(int argc, char** argv) {
    std::string line;
    for (int k = 0; k < argc; ++k)
        line += (k > 0 ? " " : "") + std::string(argv[k]);
    return line;
}

/// Under mpirun one process speaks for all; the others leave without a sign, lest it be killed before it has spoken.
int fail(const LaunchEnvironment& launch, const std::string& message, int exit_code) {
    if (launch.rank != 0) return 0;
    std::fprintf(stderr, "treefarm: %s\n", message.c_str());
    return exit_code;
}

/// What to say about a first word that is no command; "" if it is one, or an option.
std::string unknown_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        commands.push_back(command->get_name());
    if (word.starts_with('-') || std::find(commands.begin(), commands.end(), word) != commands.end()) return "";
    const std::string nearest = nearest_word(word, commands);
    return "no command is called " + in_quotes(word) + "; " +
           (nearest.empty() ? "see treefarm --help" : "did you mean " + in_quotes(nearest) + "?");
}

int run(int argc, char** argv) {
    const LaunchEnvironment launch = read_launch_environment();
    int exit_code = 0;
    CLI::App app("Path-guided rendering on one machine or many", "treefarm");
    app.set_version_flag("--version", [] { return "treefarm " + this_build().text(); });
    app.require_subcommand(1);
    add_render_command(app, launch, joined(argc, argv), exit_code);
    add_plan_command(app, launch, exit_code);
    add_check_command(app, launch, exit_code);
    add_compare_command(app, launch, exit_code);
    add_inspect_command(app, launch, exit_code);
    add_study_command(app, launch, joined(argc, argv), exit_code);
    add_report_command(app, launch);
    if (argc > 1)
        if (const std::string message = unknown_command(app, argv[1]); !message.empty())
            return fail(launch, message, 2);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {  // --help, --version
        return launch.rank == 0 ? app.exit(done) : 0;
    } catch (const CLI::ParseError& error) {
        return fail(launch, error.what() + std::string("; see treefarm --help"), 2);
    } catch (const InputError& error) {
        return fail(launch, error.what(), 2);
    } catch (const std::exception& error) {
        return fail(launch, error.what(), 1);
    }
    std::cout.flush();
    if (exit_code == 0 && (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout)))
        return fail(launch, "cannot write to the standard output", 1);
    return exit_code;
}

}  // namespace

}  // namespace treefarm

int main(int argc, char** argv) {
    treefarm::flush_denormals_if_asked();
    const treefarm::TrapFloats traps;  // threads inherit them
    return treefarm::run(argc, argv);
}
