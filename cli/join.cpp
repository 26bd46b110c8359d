// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "cli/on_farm.h"
#include "cli/option_values.h"
#include "cli/this_build.h"
#include "common/base/error.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"
#include "common/base/refuse.h"
#include "common/base/text/duration_text.h"
#include "common/base/timer.h"
#include "common/comm/join_ticket.h"
#include "common/comm/tcp_channel.h"
#include "common/runs/run_json.h"
#include "worker/local_worker.h"
#include "worker/registry.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Seconds to reconnect.
constexpr double kReturnSeconds = 60;
/// Seconds between two attempts to connect: the first, and the largest.
constexpr double kFirstPause = 0.5, kLongestPause = 10;

struct JoinOptions {
    std::string run;   ///< the run directory
    std::string file;  ///< --file
    int workers = 1;   ///< -n
    std::optional<double> wait_seconds;
    FarmOptions farm;
};

/// Ticket file of the options; throws InputError for a run directory without one, with the run's state.
fs::path ticket_file(const JoinOptions& options) {
    if (!options.file.empty()) return options.file;
    const fs::path run = options.run;
    if (fs::exists(run / kTicketFileName)) return run / kTicketFileName;
    if (!fs::exists(run / kJobFile))
        refuse(run, "is no run directory", "name the folder that a render writes its files to");
    if (fs::exists(run / kSummaryFile))
        refuse(run, "is over: there is nothing to join", "treefarm resume adds samples to it");
    refuse(run, "accepts no workers: it was started without farm.join, or was killed",
           "start it with --set farm.join=true");
}

/// Whether the render has ended for good: it is done; or a user ended it, unless this worker was told to wait. A killed
/// or failed one may be started again.
bool is_over(const JoinOptions& options) {
    if (options.run.empty()) return false;
    const std::string state = text_in(read_run_json(fs::path(options.run) / kStatusFile), "state");
    return state == "done" || (state == "interrupted" && !options.wait_seconds);
}

/// A worker that joins a run, and rejoins after each loss of its connection.
class Guest {
  public:
    Guest(const JoinOptions& options, unsigned threads, const LogOutput& log_output, const std::string& name)
        : options_(options),
          settings_(worker_here(threads, this_build().hash())),
          log_(make_log(name, {}, log_output.console, log_output.verbosity)) {}

    /// Runs the worker; returns the exit code.
    int run() {
        std::unique_ptr<Channel> channel = knock(options_.wait_seconds.value_or(0.0), [] { return false; });
        for (;;) {
            InterruptWatch watch;  // not before the first connection: until then there is nothing to give back
            settings_.told_to_leave = [&] { return told_ = told_ || watch.interrupted(); };
            const bool lost = run_worker(*channel, settings_, make_renderer, log_) == WorkerEnd::orphaned;
            channel.reset();
            if (told_) return end("left the render, as it was told");
            if (is_over(options_) || !(lost || options_.wait_seconds)) return end("the render is over");
            const double patience = options_.wait_seconds.value_or(kReturnSeconds);
            log_->info("waiting {} for the render to come back", limit_text(patience));
            try {
                channel = knock(patience, [this] { return is_over(options_); });
            } catch (const InputError& error) {
                if (is_over(options_)) return end("the render is over");
                log_->error("{}", error.what());
                return 1;
            }
            if (!channel) return end("left, as it was told");
        }
    }

  private:
    std::unique_ptr<Channel> knock_once() {
        const JoinTicket ticket = read_ticket(ticket_file(options_));
        std::unique_ptr<Channel> channel = join_run(ticket, settings_.fingerprint);
        log_->info("joined the render at {} port {} with {} threads", ticket.address, ticket.port, settings_.threads);
        return channel;
    }

    /// Connects; throws InputError if that fails for `patience` seconds, or `in_vain` is true meanwhile. Returns
    /// nullptr if told to leave.
    std::unique_ptr<Channel> knock(double patience, const std::function<bool()>& in_vain) {
        const Timer timer;
        for (double pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
            try {
                return knock_once();
            } catch (const InputError&) {
                if (timer.seconds() + pause > patience || in_vain()) throw;
            }
            if (rest(pause)) return nullptr;
        }
    }

    int end(const char* words) const {
        log_->info("{}", words);
        return 0;
    }

    /// Waits `seconds`; true if told to leave meanwhile.
    bool rest(double seconds) {
        const Timer timer;
        while (!told_ && timer.seconds() < seconds) {
            told_ = settings_.told_to_leave && settings_.told_to_leave();
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return told_;
    }

    const JoinOptions& options_;
    WorkerSettings settings_;
    const Log log_;
    bool told_ = false;
};

/// Forks `workers` worker processes and waits for them. Returns the worker's number in a worker process; 0 in the
/// parent, after the wait, with `code` set to the worst exit code.
int as_many(int workers, int& code) {
    std::vector<pid_t> processes;
    const pid_t parent = getpid();
    for (int k = 1; k <= workers; ++k) {
        const pid_t process = fork();
        if (process < 0) throw RunError(std::string("cannot start a worker: ") + std::strerror(errno));
        if (process == 0) {
            prctl(PR_SET_PDEATHSIG, SIGTERM);
            if (getppid() != parent) std::_Exit(1);  // the parent died before prctl
            return k;
        }
        processes.push_back(process);
    }
    InterruptWatch watch;
    bool told = false;
    while (!processes.empty()) {
        if (!told && watch.interrupted()) {
            told = true;
            for (const pid_t process : processes)
                ::kill(process, SIGTERM);
        }
        std::erase_if(processes, [&](pid_t process) {
            int status = 0;
            if (waitpid(process, &status, WNOHANG) != process) return false;
            code = std::max(code, WIFEXITED(status) ? WEXITSTATUS(status) : 1);
            return true;
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return 0;
}

void check(const JoinOptions& options) {
    if (!options.file.empty() && !options.run.empty())
        refuse("--file", "is given beside a run directory, and either says which run to join", "leave one away");
    if (options.file.empty() && options.run.empty())
        refuse("join", "does not know which run to join",
               "name its run directory, or a copy of its file join by --file");
    if (!options.wait_seconds) read_ticket(ticket_file(options));  // fails once here rather than in each process
}

int join(const LaunchEnvironment& launch, const JoinOptions& options) {
    check(options);
    ignore_broken_pipes();
    const unsigned workers = static_cast<unsigned>(options.workers);
    const unsigned threads =
        options.farm.threads > 0 ? options.farm.threads : std::max(1u, affinity_threads() / workers);
    int code = 0;
    const int number = workers > 1 ? as_many(options.workers, code) : 1;
    if (number == 0) return code;
    const LogOutput log_output = make_log_output(launch, options.farm);
    const std::string name = "joined worker" + (workers > 1 ? " " + std::to_string(number) : "");
    std::vector<std::string> warnings;
    if (number == 1) warn_if_crowded(threads * workers, warnings);
    for (const std::string& warning : warnings)
        make_log(name, {}, log_output.console, log_output.verbosity)->warn("{}", warning);
    return Guest(options, threads, log_output, name).run();
}

}  // namespace

void add_join_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<JoinOptions>();
    CLI::App* command = app.add_subcommand("join", "Joins a running render as a worker, from this or another machine");
    command->add_option("run", options->run, "run directory of a render with farm.join = true");
    add_text_option(*command, "--file", options->file, "a copy of that folder's file join, where no disk is shared");
    add_integer_option(*command, "-n", options->workers, {1, 1024, "workers", "2"},
                       "number of worker processes, as one for each processor's memory; they share the processors "
                       "(default: 1)");
    add_seconds_option(*command, "--wait", options->wait_seconds,
                       "how long to wait for a render that has not started, or was lost before it was done (default: 0 "
                       "s for one that has not started, 60 s for a lost one)");
    add_log_options(*command, options->farm);
    command->footer(std::string("treefarm render scene.xml --run-dir RUN_DIR --set farm.join=true\n") +
                    "treefarm join RUN_DIR\n" +
                    "Exit codes: 0 the render is over, or this worker was told to leave, 1 the connection was lost, 2 "
                    "bad usage, or the\nrender refused it");
    command->callback([options, launch, &exit_code] { exit_code = join(launch, *options); });
}

}  // namespace treefarm
