// SPDX-License-Identifier: Apache-2.0
#include "cli/join.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/interrupt.h"
#include "cli/on_farm.h"
#include "cli/option_values.h"
#include "cli/refuse.h"
#include "common/base/error.h"
#include "common/comm/join_ticket.h"
#include "common/comm/tcp_channel.h"
#include "worker/integrators/registry.h"
#include "worker/worker_loop.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

struct JoinOptions {
    std::string run;   ///< the run directory
    std::string file;  ///< --file
    FarmOptions farm;
};

/// The ticket's file; refuses a run directory without one with what is known of the run.
fs::path ticket_file(const JoinOptions& options) {
    if (!options.file.empty() && !options.run.empty())
        refuse("--file", "is given beside a run directory, and either says which run to join", "leave one away");
    if (!options.file.empty()) return options.file;
    if (options.run.empty())
        refuse("join", "does not know which run to join",
               "name its run directory, or a copy of its file join by --file");
    const fs::path run = options.run;
    if (fs::exists(run / kTicketFileName)) return run / kTicketFileName;
    if (!fs::exists(run / "job.toml"))
        refuse(run, "is no run directory", "name the folder that a render writes its files to");
    if (fs::exists(run / "summary.json"))
        refuse(run, "is over: there is nothing to join", "treefarm resume adds samples to it");
    refuse(run, "takes no workers in: it was started without farm.join, or was killed",
           "start it with --set farm.join=true");
}

int join(const LaunchEnvironment& launch, const JoinOptions& options) {
    const JoinTicket ticket = read_ticket(ticket_file(options));
    ignore_broken_pipes();
    const unsigned threads = options.farm.threads > 0 ? options.farm.threads : affinity_threads();
    const WorkerSettings settings = worker_settings(threads);
    const std::unique_ptr<Channel> channel = join_run(ticket, settings.fingerprint);
    const Voice voice = make_voice(launch, options.farm);
    const Log log = make_log("joined worker", {}, voice.console, voice.loudness);
    std::vector<std::string> warnings;
    warn_if_crowded(options.farm.threads, warnings);
    for (const std::string& warning : warnings)
        log->warn("{}", warning);
    log->info("joined the render at {} port {} with {} threads", ticket.address, ticket.port, threads);
    const WorkerEnd end = run_worker(*channel, settings, make_renderer, log);
    if (end == WorkerEnd::orphaned) return 1;
    log->info("the render is over");
    return 0;
}

}  // namespace

void add_join_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<JoinOptions>();
    CLI::App* command = app.add_subcommand("join", "Works for a render that runs, from this or another machine");
    command->add_option("run", options->run, "run directory of a render with farm.join = true");
    add_text_option(*command, "--file", options->file, "a copy of that folder's file join, where no disk is shared");
    add_voice_options(*command, options->farm);
    command->footer(std::string("treefarm render scene.xml --run-dir RUN_DIR --set farm.join=true\n") +
                    "treefarm join RUN_DIR\n" +
                    "Exit codes: 0 the render is over, 1 the connection was lost, 2 bad usage, or the render did not "
                    "let it in");
    command->callback([options, launch, &exit_code] { exit_code = join(launch, *options); });
}

}  // namespace treefarm
