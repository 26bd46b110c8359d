// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/launch_environment.h"
#include "cli/option_values.h"
#include "cli/this_build.h"
#include "cli/usage.h"
#include "common/base/error.h"
#include "common/base/float_traps.h"
#include "common/base/interrupt.h"
#include "common/base/text/printable.h"

namespace treefarm {

namespace {

std::string joined(int argc, char** argv) {
    std::string line;
    for (int k = 0; k < argc; ++k)
        line += (k > 0 ? " " : "") + std::string(argv[k]);
    return line;
}

/// Delay in which rank 0 reports an error for all ranks: if all have the same bad option, mpirun ends them within it. A
/// rank still alive then has an error of its own to report.
constexpr std::chrono::seconds kFirstRankSpeaks{3};

int fail(const LaunchEnvironment& launch, const std::string& message, int exit_code) {
    if (launch.rank == 0) {
        std::fprintf(stderr, "treefarm: %s\n", printable_lines(message).c_str());
        if (launch.life) {  // a supervisor need not restart after a user's error
            launch.life->begin();
            launch.life->end(exit_code);
        }
        return exit_code;
    }
    std::this_thread::sleep_for(kFirstRankSpeaks);
    std::fprintf(stderr, "treefarm: rank %d: %s\n", launch.rank, printable_lines(message).c_str());
    return exit_code;
}

int run(int argc, char** argv) {
    const LaunchEnvironment launch = read_launch_environment();
    int exit_code = 0;
    CLI::App app("Path-guided rendering on one machine or many", "treefarm");
    app.set_version_flag("--version", [] { return "treefarm " + this_build().text(); });
    app.require_subcommand(1);
    add_render_command(app, launch, joined(argc, argv), exit_code);
    add_resume_command(app, launch, joined(argc, argv), exit_code);
    add_launch_command(app, launch, exit_code);
    add_join_command(app, launch, exit_code);
    add_serve_command(app, launch, exit_code);
    add_plan_command(app, launch, exit_code);
    add_check_command(app, launch, exit_code);
    add_compare_command(app, launch, exit_code);
    add_convert_command(app, launch, exit_code);
    add_inspect_command(app, launch, exit_code);
    add_study_command(app, launch, joined(argc, argv), exit_code);
    add_report_command(app, launch);
    add_keys_command(app, launch, exit_code);
    app.footer(std::string("treefarm COMMAND --help lists the options of a command and their defaults, treefarm keys "
                           "those of a job.\n") +
               kExitCodesText);
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    if (!arguments.empty() && arguments[0] == "help") {  // treefarm help [COMMAND]
        arguments.erase(arguments.begin());
        arguments.resize(std::min<std::size_t>(arguments.size(), 1));
        arguments.emplace_back("--help");
    }
    if (!arguments.empty())
        if (const std::string message = unknown_command(app, arguments[0]); !message.empty())
            return fail(launch, message, 2);
    if (const std::string message = malformed_argument(arguments); !message.empty()) return fail(launch, message, 2);
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them from the back
    } catch (const CLI::Success& done) {                                            // --help, --version
        return launch.rank == 0 ? app.exit(done) : 0;
    } catch (const CLI::ParseError& error) {
        return fail(launch, usage_message(app, error, arguments), 2);
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
    treefarm::ignore_size_limits();
    const treefarm::TrapFloats traps;  // threads inherit them
    return treefarm::run(argc, argv);
}
