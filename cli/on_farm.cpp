#include "cli/on_farm.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <thread>

#include "cli/interrupt.h"
#include "common/base/error.h"
#include "common/comm/in_process_channel.h"
#include "common/comm/mpi_channel.h"
#include "common/protocol/fingerprint.h"
#include "coordinator/farm.h"
#include "worker/worker_loop.h"

namespace treefarm {

namespace {

/// How long the end waits for workers, and MPI_Finalize for everybody.
constexpr double kDismissSeconds = 5.0;
constexpr double kFinalizeSeconds = 10.0;

WorkerSettings worker_settings(unsigned threads) {
    return {threads, host_name(), own_fingerprint().hash(), 30.0};
}

/// Coordinator and one worker in this process.
int run_here(unsigned threads, bool quiet, const FarmTask& task) {
    task.prepare();
    InterruptWatch watch;
    auto channels = make_in_process_channels(2);
    std::thread worker([&channel = *channels[1], threads = threads > 0 ? threads : affinity_threads(), quiet] {
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
        const CoordinatorEnd end = task.coordinate(*channels[0], [&] { return watch.interrupted(); });
        send_away();
        return end.code;
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

CoordinatorEnd guarded(const std::function<CoordinatorEnd()>& act) {
    try {
        return act();
    } catch (const InputError& error) {
        return {complain(error, 2), {}};
    } catch (const std::exception& error) {
        return {complain(error, 1), {}};
    }
}

int coordinate(MpiSession& session, const FarmTask& task, InterruptWatch& watch) {
    const CoordinatorEnd end = guarded([&] {
        task.prepare();
        return task.coordinate(session.channel(), [&] { return watch.interrupted(); });
    });
    session.finish(dismiss_workers(session.channel(), end.lost, kDismissSeconds), end.code, kFinalizeSeconds);
    return end.code;
}

int work(MpiSession& session, unsigned asked, bool quiet) {
    const unsigned share = affinity_threads() / static_cast<unsigned>(std::max(1, session.workers_on_host()));
    const unsigned threads = asked > 0 ? asked : std::max(1u, share);
    const Log log = make_log("worker " + std::to_string(session.rank()), {}, quiet);
    std::vector<std::string> warnings;
    warn_if_crowded(asked, warnings);
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

}  // namespace

int run_on_farm(const LaunchEnvironment& launch, unsigned threads, bool quiet, const FarmTask& task) {
    ignore_broken_pipes();
    if (!launch.under_mpi) return run_here(threads, quiet, task);
    if (launch.one_host) skip_network_search();
    InterruptWatch watch;  // before MPI starts its threads; workers leave when the coordinator says so
    MpiSession session;
    if (session.size() > 1)
        return session.rank() == 0 ? coordinate(session, task, watch) : work(session, threads, quiet);
    const int code = guarded([&]() -> CoordinatorEnd { return {run_here(threads, quiet, task), {}}; }).code;
    session.finish(true, code, kFinalizeSeconds);
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
