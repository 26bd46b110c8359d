// SPDX-License-Identifier: Apache-2.0
#include "cli/on_farm.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>

#include "cli/option_values.h"
#include "cli/this_build.h"
#include "common/base/error.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"
#include "common/comm/mpi_channel.h"
#include "common/comm/multi_channel.h"
#include "common/comm/run_key.h"
#include "coordinator/farm/pulse.h"
#include "worker/local_worker.h"
#include "worker/registry.h"

namespace treefarm {

namespace {

/// Seconds that the end waits for workers, and MPI_Finalize for all processes.
constexpr double kDismissSeconds = FarmLimits().dismiss;
constexpr double kFinalizeSeconds = 10.0;

/// Runs the coordinator and one worker in this process.
int run_here(const FarmOptions& options, const LogOutput& log_output, const FarmTask& task) {
    task.prepare();
    InterruptWatch watch;  // before threads start
    LocalFarm farm(local_worker(options.threads, log_output));
    return task.coordinate({.channel = &farm.channel(), .stop = [&] { return watch.interrupted(); }}).code;
}

/// Prints an error as main() would, since the MPI job must be ended in order before that.
int complain(const std::exception& error, int code) {
    std::fprintf(stderr, "treefarm: %s\n", error.what());
    return code;
}

CoordinatorEnd guarded(const std::function<CoordinatorEnd()>& act) {
    try {
        return act();
    } catch (const InputError& error) {
        return {complain(error, 2), {}};
    } catch (const std::exception& error) {
        return {complain(error, 1), {}};
    }
}

/// Whether mpirun alone wanted the end. Slurm signals a step's tasks through their parent, too, but a preempted job
/// must end.
bool ended_by_launcher(const LaunchEnvironment& launch, const InterruptWatch& watch) {
    return watch.told_by_parent() && !launch.in_slurm;
}

/// Dismisses every worker and exits: a signal came while the scene was being read, which cannot be interrupted.
[[noreturn]] void leave_reading(const LaunchEnvironment& launch, MpiSession& session, bool by_launcher) {
    if (launch.life) launch.life->end(3, by_launcher);
    const bool orderly = dismiss_workers(session.channel(), {}, kDismissSeconds);
    std::fputs("treefarm: interrupted while the input was being read\n", stderr);
    session.finish(orderly, 3, kFinalizeSeconds);
    std::_Exit(3);
}

/// Reads the input in the background, so that workers receive heartbeats however long it takes.
void prepare(const LaunchEnvironment& launch, MpiSession& session, const FarmTask& task, InterruptWatch& watch) {
    Pulse pulse(session.channel());
    run_in_background(task.prepare, [&] {
        if (watch.interrupted()) leave_reading(launch, session, ended_by_launcher(launch, watch));
        pulse.beat();
    });
}

int coordinate(const LaunchEnvironment& launch, MpiSession& session, const FarmTask& task, InterruptWatch& watch) {
    MultiChannel channel(session.channel());
    const CoordinatorEnd end = guarded([&] {
        prepare(launch, session, task, watch);
        return task.coordinate({.channel = &channel, .stop = [&] { return watch.interrupted(); }});
    });
    if (launch.life) launch.life->end(end.code, ended_by_launcher(launch, watch));
    const bool orderly = dismiss_workers(channel, end.lost, kDismissSeconds);
    channel.close();
    session.finish(orderly, end.code, kFinalizeSeconds);
    return end.code;
}

int work(MpiSession& session, const FarmOptions& options, const LogOutput& log_output, InterruptWatch& watch) {
    const unsigned asked = options.threads;
    const unsigned portion = affinity_threads() / static_cast<unsigned>(std::max(1, session.workers_on_host()));
    const unsigned threads = asked > 0 ? asked : std::max(1u, portion);
    const Log log = make_log("worker " + std::to_string(session.rank()), {}, log_output.console, log_output.verbosity);
    std::vector<std::string> warnings;
    warn_if_crowded(asked, warnings);
    if (affinity_threads() < host_processors() / static_cast<unsigned>(std::max(1, session.workers_on_host())))
        warnings.push_back("bound to " + std::to_string(affinity_threads()) + " of " +
                           std::to_string(host_processors()) +
                           " processors; start mpirun with --bind-to none, srun with --cpu-bind=none");
    for (const std::string& warning : warnings)
        log->warn("{}", warning);
    try {
        WorkerSettings settings = worker_here(threads, this_build().hash());
        settings.told_to_leave = [&watch] { return watch.terminated(); };
        const WorkerEnd end = run_worker(session.channel(), settings, make_renderer, log);
        const int code = end == WorkerEnd::orphaned ? 1 : 0;
        session.finish(end == WorkerEnd::orderly, code, kFinalizeSeconds);
        return code;
    } catch (const std::exception& error) {
        log->error("{}", error.what());
        session.finish(false, 1, kFinalizeSeconds);
        return 1;
    }
}

/// Key that treefarm launch left for its processes, if this host sees it.
std::optional<JoinKey> run_key(const LaunchEnvironment& launch) {
    if (launch.key_file.empty()) return std::nullopt;
    try {
        return read_run_key(launch.key_file);
    } catch (const InputError& error) {
        std::fprintf(stderr, "treefarm: rank %d: %s\n", launch.rank, error.what());
        return std::nullopt;
    }
}

/// Logs which messages are not authenticated, if they go over a network.
void tell_trust(const LaunchEnvironment& launch, const MpiSession& session, const LogOutput& log_output) {
    if (session.size() == 1 || session.rank() != 0 || session.is_sealed()) return;
    const Log log = make_log("coordinator", {}, log_output.console, log_output.verbosity);
    if (!launch.key_file.empty())
        log->warn("not all processes can read {}: messages are not authenticated, and the network is trusted",
                  launch.key_file.string());
    else if (!launch.one_host)
        log->info("messages between hosts are not authenticated: the network is trusted (treefarm launch makes a key)");
}

std::string missing_processes(const LaunchEnvironment& launch, double seconds) {
    const std::string all = launch.size > 0 ? "the " + std::to_string(launch.size) : "all";
    char limit[32] = "";
    std::snprintf(limit, sizeof limit, "%g", seconds);
    return "treefarm: rank " + std::to_string(launch.rank) + ": " + all +
           " processes of this job did not come together in " + limit +
           " s: one died or left at its start (it may have said why above), or a host is out of reach; start again, "
           "with --start-seconds if they need longer\n";
}

}  // namespace

LogOutput errors_only() {
    return {std::make_shared<Console>(TerminalKind{}, false), Verbosity::quiet};
}

LocalWorker local_worker(unsigned threads, const LogOutput& log_output) {
    return [threads, log_output](Channel& own) {
        const Log log = make_log("worker", {}, log_output.console, log_output.verbosity);
        run_local_worker(own, threads, this_build().hash(), log);
    };
}

void add_log_options(CLI::App& command, FarmOptions& options) {
    add_threads_option(command, options.threads, "tracing threads of each process (default: its processors)");
    command.add_flag("-q,--quiet", options.quiet, "only errors on the terminal");
    command.add_flag("-v,--verbose", options.verbose, "every figure of each pass on the terminal")->excludes("--quiet");
}

void add_farm_options(CLI::App& command, FarmOptions& options) {
    add_log_options(command, options);
    add_number_option(command, "--start-seconds", options.start_seconds, {1, 1e6, "seconds", "60"},
                      "under mpirun: in which all processes have to come together (default: 25)");
}

LogOutput make_log_output(const LaunchEnvironment& launch, const FarmOptions& options) {
    return {std::make_shared<Console>(launch.terminal, !options.quiet), options.quiet     ? Verbosity::quiet
                                                                        : options.verbose ? Verbosity::verbose
                                                                                          : Verbosity::normal};
}

namespace {

int run_processes(const LaunchEnvironment& launch, const FarmOptions& options, const LogOutput& log_output,
                  const FarmTask& task) {
    if (!launch.under_mpi) {
        if (launch.life) launch.life->begin();
        return run_here(options, log_output, task);
    }
    if (launch.one_host) skip_network_search();
    InterruptWatch watch;  // before MPI starts its threads
    MpiSession session(options.start_seconds, missing_processes(launch, options.start_seconds), run_key(launch));
    if (launch.life) launch.life->begin();
    tell_trust(launch, session, log_output);
    if (session.size() > 1)
        return session.rank() == 0 ? coordinate(launch, session, task, watch)
                                   : work(session, options, log_output, watch);
    const int code = guarded([&]() -> CoordinatorEnd { return {run_here(options, log_output, task), {}}; }).code;
    if (launch.life) launch.life->end(code);
    session.finish(true, code, kFinalizeSeconds);
    return code;
}

}  // namespace

int run_on_farm(const LaunchEnvironment& launch, const FarmOptions& options, const LogOutput& log_output,
                const FarmTask& task) {
    ignore_broken_pipes();
    const int code = run_processes(launch, options, log_output, task);
    if (launch.life) launch.life->end(code);
    return code;
}

void warn_if_crowded(unsigned threads, std::vector<std::string>& warnings) {
    const unsigned processors = affinity_threads();
    if (threads > processors)
        warnings.push_back(std::to_string(threads) + " threads were asked for, but this process may run on " +
                           std::to_string(processors) +
                           " processors only; lower --threads, or start mpirun with "
                           "--bind-to none");
}

}  // namespace treefarm
