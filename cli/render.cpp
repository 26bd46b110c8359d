#include "cli/render.h"

#include <pthread.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <memory>
#include <thread>

#include "cli/debug_sample.h"
#include "cli/interrupt.h"
#include "common/comm/in_process_channel.h"
#include "common/comm/mpi_channel.h"
#include "common/protocol/fingerprint.h"
#include "worker/worker_loop.h"

namespace treefarm {

namespace {

/// How long the end waits for workers, and MPI_Finalize for everybody.
constexpr double kDismissSeconds = 5.0;
constexpr double kFinalizeSeconds = 10.0;

int exit_code_of(const RenderOutcome& outcome) {
    switch (outcome.state) {
        case RunState::done:
            return outcome.missed_target ? 4 : 0;
        case RunState::interrupted:
            return 3;
        default:
            return 1;
    }
}

WorkerSettings worker_settings(unsigned threads) {
    return {threads, host_name(), own_fingerprint().hash(), 30.0};
}

void warn_if_crowded(const RenderOptions& options, std::vector<std::string>& warnings) {
    const unsigned processors = affinity_threads();
    if (options.threads > processors)
        warnings.push_back(std::to_string(options.threads) + " threads were asked for, but this process may run on " +
                           std::to_string(processors) +
                           " processors only; lower --threads, or start mpirun with "
                           "--bind-to none");
}

/// Coordinator and one worker in this process.
int render_here(const RenderOptions& options) {
    RenderRequest request = read_request(options);
    if (!options.debug_sample.empty()) return debug_sample(request, parse_sample_name(options.debug_sample));
    warn_if_crowded(options, request.warnings);
    request.progress_bar = !options.quiet && isatty(STDERR_FILENO);
    InterruptWatch watch;  // from here on, so that reading a scene can be broken off
    auto channels = make_in_process_channels(2);
    const unsigned threads = options.threads > 0 ? options.threads : affinity_threads();
    std::thread worker([&channel = *channels[1], threads, quiet = options.quiet] {
        const Log log = make_log("worker", {}, quiet);
        try {
            run_worker(channel, worker_settings(threads), make_path_renderer, log);
        } catch (const std::exception& error) {  // the coordinator notices the silence
            log->error("{}", error.what());
        }
    });
    const auto send_away = [&] {
        dismiss_workers(*channels[0], {}, kDismissSeconds);
        worker.join();
    };
    try {
        const RenderOutcome outcome = run_render(*channels[0], request, [&] { return watch.interrupted(); });
        send_away();
        return exit_code_of(outcome);
    } catch (...) {
        send_away();
        throw;
    }
}

/// Prints what is wrong, as main() would, since the job must be ended in order before.
int complain(const std::exception& error, int code) {
    std::fprintf(stderr, "treefarm: %s\n", error.what());
    return code;
}

int coordinate(MpiSession& session, const RenderOptions& options, InterruptWatch& watch) {
    std::set<int> lost;
    int code = 0;
    try {
        if (!options.debug_sample.empty())
            throw InputError(Location{"--debug-sample", 0, 0}, "traces one sample in one process", "leave mpirun away");
        RenderRequest request = read_request(options);
        request.progress_bar = !options.quiet && isatty(STDERR_FILENO);
        const RenderOutcome outcome = run_render(session.channel(), request, [&] { return watch.interrupted(); });
        lost = outcome.lost_peers;
        code = exit_code_of(outcome);
    } catch (const InputError& error) {
        code = complain(error, 2);
    } catch (const std::exception& error) {
        code = complain(error, 1);
    }
    session.finish(dismiss_workers(session.channel(), lost, kDismissSeconds), code, kFinalizeSeconds);
    return code;
}

int work(MpiSession& session, const RenderOptions& options) {
    const unsigned share = affinity_threads() / static_cast<unsigned>(std::max(1, session.workers_on_host()));
    const unsigned threads = options.threads > 0 ? options.threads : std::max(1u, share);
    const Log log = make_log("worker " + std::to_string(session.rank()), {}, options.quiet);
    std::vector<std::string> warnings;
    warn_if_crowded(options, warnings);
    if (affinity_threads() < host_processors() / static_cast<unsigned>(std::max(1, session.workers_on_host())))
        warnings.push_back("bound to " + std::to_string(affinity_threads()) + " of " +
                           std::to_string(host_processors()) + " processors; start mpirun with --bind-to none");
    for (const std::string& warning : warnings)
        log->warn("{}", warning);
    try {
        const WorkerEnd end = run_worker(session.channel(), worker_settings(threads), make_path_renderer, log);
        const int code = end == WorkerEnd::orphaned ? 1 : 0;
        session.finish(end == WorkerEnd::orderly, code, kFinalizeSeconds);
        return code;
    } catch (const std::exception& error) {
        log->error("{}", error.what());
        session.finish(false, 1, kFinalizeSeconds);
        return 1;
    }
}

int render_under_mpi(const RenderOptions& options) {
    InterruptWatch watch;  // before MPI starts its threads; workers leave when the coordinator says so
    MpiSession session;
    if (session.size() > 1) return session.rank() == 0 ? coordinate(session, options, watch) : work(session, options);
    int code = 0;
    try {
        code = render_here(options);
    } catch (const InputError& error) {
        code = complain(error, 2);
    } catch (const std::exception& error) {
        code = complain(error, 1);
    }
    session.finish(true, code, kFinalizeSeconds);
    return code;
}

}  // namespace

void add_render_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                        int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    options->command = command_line;
    CLI::App* command = app.add_subcommand("render", "Renders a scene, under mpirun on all its processes");
    command->add_option("input", options->input, "Mitsuba scene (.xml) or job (.toml)")->required();
    command->add_option("-o,--output", options->output, "also write the image to this EXR file");
    command->add_option("--spp", options->spp, "samples per pixel, rounded up to whole passes' units");
    command->add_option("--seconds", options->seconds, "seconds of rendering");
    command->add_option("--error", options->error, "stop at this RMSE / mean luminance: 0.05 is 5 %");
    command->add_option("--schedule", options->schedule, "repeat the passes of this schedule.toml");
    command->add_option("--set", options->set, "key=value: sets a key of the job")->allow_extra_args(false);
    command->add_option("-D", options->defines, "name=value: gives $name in the scene a value")
        ->allow_extra_args(false);
    command->add_flag("--lenient", options->lenient, "replace what the scene reader does not know instead of refusing");
    command->add_option("--run-dir", options->run_directory, "where results go (default: runs/<scene>-<time>)");
    command->add_option("--threads", options->threads, "tracing threads of each process (default: its processors)")
        ->check(CLI::Range(1u, 4096u));
    command->add_flag("--quiet", options->quiet, "only errors on the terminal");
    command->add_option("--debug-sample", options->debug_sample,
                        "pass,x,y,sample: trace this sample and tell its story");
    command->callback([options, launch, &exit_code] {
        exit_code = launch.under_mpi ? render_under_mpi(*options) : render_here(*options);
    });
}

}  // namespace treefarm
