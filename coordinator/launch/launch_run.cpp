// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_run.h"

#include <poll.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"
#include "common/base/text/parse_text.h"
#include "common/base/text/printable.h"
#include "common/base/timer.h"
#include "common/comm/run_key.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "coordinator/launch/attempt_folders.h"
#include "coordinator/launch/attempt_processes.h"
#include "coordinator/launch/child_process.h"
#include "coordinator/launch/host_keys.h"
#include "coordinator/launch/launch_folder.h"
#include "coordinator/launch/launch_output.h"
#include "coordinator/launch/launch_plan.h"
#include "coordinator/launch/launch_signals.h"
#include "coordinator/launch/launch_words.h"
#include "coordinator/launch/launched_command.h"
#include "coordinator/launch/supervisor.h"
#include "coordinator/launch/sweep.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

namespace {

/// Interval of reading the heartbeat file.
constexpr int kLookMilliseconds = 1000;
/// Seconds for killed processes to end.
constexpr double kKillPatience = 5.0;
/// Seconds for another host's process to release the run directory.
constexpr double kFolderPatience = 30.0;

std::string random_name() {
    std::random_device device;
    char text[9] = "";
    std::snprintf(text, sizeof text, "%08x", device());
    return text;
}

/// Whether a coordinator of this host has ended: it has no process here, and its lock of the run directory, which also
/// one in a container holds, is free.
bool is_gone(const LifeStatus& coordinator, const std::filesystem::path& run) {
    if (coordinator.host != host_name() || ::kill(coordinator.pid, 0) == 0 || errno != ESRCH) return false;
    return !FolderLock(run, 0.0, nullptr).refused();
}

/// Prints to the terminal; a closed terminal ends nothing.
void tell(const std::string& text) {
    if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;
}

class LaunchRun {
  public:
    LaunchRun(const LaunchOptions& options, LaunchedCommand command)
        : options_(options),
          command_(std::move(command)),
          planner_(options),
          folder_(command_),
          supervisor_(limits(options), actions(), [this](int number) { return name_of(number); }) {}

    int run() {
        try {
            for (;;) {
                if (const auto end = supervisor_.step(look())) return finish(*end);
                wait();
            }
        } catch (const std::exception&) {
            clean_up();
            if (!started_) folder_.give_back();
            throw;
        }
    }

  private:
    static SupervisorLimits limits(const LaunchOptions& options) {
        SupervisorLimits limits;
        limits.restarts = options.restarts;
        limits.stall = options.stall_seconds;
        return limits;
    }

    SupervisorActions actions() {
        return {[this](int number) { start(number); },
                [this] { child_->signal(SIGUSR1); },
                [this](const LifeStatus& status) { dump(status); },
                [this] { child_->signal(SIGTERM); },
                [this] {
                    child_->signal_group(SIGKILL);
                    kill_attempt(name(), 0.0);
                },
                [this](const std::string& words) { say(words); }};
    }

    std::string name_of(int number) const { return launch_ + "." + std::to_string(number); }
    std::string name() const { return name_of(supervisor_.attempt()); }

    Sight look() {
        Sight sight;
        relay();
        sight.running = child_ && child_->running();
        sight.not_started = not_started_;
        if (child_ && !sight.running) end_child();
        sight.coordinator_gone = seen_ && is_gone(*seen_, folder_.run());
        folder_.remake();
        // Read after the processes have ended, so that their last heartbeat counts.
        sight.status = newest_sign(sight.readable);
        if (supervisor_.attempt() > 0) sight.summary = folder_.summary(name());
        if (!sight.running) sight.checkpoint = folder_.checkpoint();
        if (!sight.running && supervisor_.attempt() > 0)
            sight.disk = start_trouble_.empty() ? folder_.trouble() : std::exchange(start_trouble_, "");
        if (sight.running && sight.status && sight.status->attempt == name()) seen_ = sight.status;
        sight.now = clock_.seconds();
        return sight;
    }

    /// The coordinator's last sign of life: that of its file, or one in its output while the file cannot be written.
    std::optional<LifeStatus> newest_sign(bool& readable) const {
        const std::optional<LifeStatus> file = folder_.life(readable), &printed = output_.sign();
        if (!printed || printed->attempt != name()) return file;
        return file && file->attempt == name() && file->beat >= printed->beat ? file : printed;
    }

    /// Ends all processes of an attempt after its launcher: none may run beside the next attempt.
    void end_child() {
        relay();
        pass_on(output_.take_rest());
        note("launcher: " + child_->ending());
        child_.reset();
        clean_up();
        if (seen_) planner_.note_end(seen_->workers);
        seen_.reset();
    }

    void clean_up() {
        if (supervisor_.attempt() > 0 && !kill_attempt(name(), kKillPatience))
            note("processes of the attempt cannot be killed");
        folders_.reset();
        std::error_code none;
        std::filesystem::remove(key_file(), none);
        host_keys_.reset();
    }

    std::filesystem::path key_file() const { return folder_.own() / kRunKeyName; }

    /// Starts an attempt. A failed start counts as an end of the attempt, except for the first one: hosts may come
    /// back.
    void start(int number) {
        not_started_.clear();
        try {
            begin(number);
            started_ = true;
        } catch (const std::exception& error) {
            if (number == 1) throw;
            not_started_ = error.what();
            if (dynamic_cast<const FileError*>(&error)) start_trouble_ = not_started_;
            clean_up();
        }
    }

    void begin(int number) {
        sweep();
        if (number > 1) wait_for_folder();
        StartPlan plan = planner_.plan(folder_.own() / ("hostfile-" + std::to_string(number)));
        folders_ = std::make_unique<AttemptFolders>(plan, key_file());
        if (!folders_->trouble().empty()) note(folders_->trouble());
        if (number == 1) was_empty_ = folder_content(folder_.run()) == FolderContent::nothing;
        const bool goes_on = number > 1 && (was_empty_ || folder_.was_taken_by(launch_));
        const std::vector<std::string> words = goes_on ? command_.again(can_go_on(folder_.run())) : command_.first();
        const std::vector<std::string> command = start_command(plan, words);
        note("attempt " + std::to_string(number) + ": " + shell_line(command));
        std::vector<std::string> variables;
        for (const std::string& warning : plan.warnings)
            say("warning: " + warning);
        if (!plan.warnings.empty())
            variables.push_back(std::string(kWarningsVariable) + "=" +
                                fmt::format("{}", fmt::join(plan.warnings, "; ")));
        const LifeAttempt attempt{name_of(number), folder_.life_file()};
        write_run_key(key_file());
        if (!plan.hosts.empty()) host_keys_ = std::make_unique<HostKeys>(plan.hosts, key_file(), name_of(number));
        variables.push_back(std::string(kAttemptVariable) + "=" + attempt_text(attempt));
        output_ = {};
        child_ = std::make_unique<ChildProcess>(command, variables);
    }

    /// Waits for the run directory: a coordinator on another host may outlive its launcher.
    void wait_for_folder() const {
        const FolderLock lock(folder_.run(), kFolderPatience, nullptr);
        if (lock.refused()) throw RunError(folder_.run().string() + " is still in use by an attempt that was ended");
    }

    /// Makes a coordinator without progress dump core, if the host allows.
    void dump(const LifeStatus& status) const {
        if (status.host != host_name()) return;
        for (const pid_t process : attempt_processes(name()))
            if (process == status.pid) ::kill(process, SIGABRT);
    }

    /// Waits for an event, or for the next reading of the heartbeat.
    void wait() {
        pollfd ends[2] = {{signals_.descriptor(), POLLIN, 0}, {child_ ? child_->words_descriptor() : -1, POLLIN, 0}};
        poll(ends, 2, kLookMilliseconds);
        // A launcher that closed its pipe is about to exit.
        if ((ends[1].revents & POLLHUP) != 0) poll(ends, 1, kLookMilliseconds / 10);
        for (const int number : signals_.take())
            take(number);
    }

    void take(int number) {
        switch (number) {
            case SIGCHLD:
                return;
            case SIGTSTP:
                if (child_) child_->signal(planner_.stands_alone() ? SIGSTOP : SIGTSTP);
                raise(SIGSTOP);
                return;
            case SIGCONT:
                if (child_) child_->signal(SIGCONT);
                return;
            default:
                supervisor_.ask_to_stop();
        }
    }

    /// Copies the output of launcher and ranks to the terminal and to the log.
    void relay() {
        if (!child_) return;
        pass_on(output_.take(child_->take_words(), seen_.has_value()));
    }

    void pass_on(const LaunchOutput::Lines& lines) {
        if (!lines.terminal.empty()) tell(lines.terminal);
        log(lines.log);
    }

    void say(const std::string& words) {
        tell("treefarm: launch: " + printable(words) + "\n");
        note(words);
    }

    void note(const std::string& words) { log("launch: " + printable(words) + "\n"); }

    /// Appends to the log. What a full disk does not take is lost, and no more.
    void log(const std::string& text) const {
        const Descriptor file = Descriptor::open(folder_.own() / "log",
                                                 O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK, mode_t{0666});
        if (file && write(file.fd(), text.data(), text.size()) < 0) return;
    }

    int finish(const SupervisorEnd& end) {
        sweep();
        if (end.resumable) say((end.words.empty() ? "interrupted" : end.words) + "; " + what_is_kept());
        if (end.code == 2) folder_.give_back();
        return end.code;
    }

    /// Description of the saved state, and the command that resumes.
    std::string what_is_kept() const {
        const std::string again = launch_words(options_);
        if (command_.kind == LaunchedCommand::Kind::render || command_.kind == LaunchedCommand::Kind::resume) {
            if (folder_.checkpoint() == 0)
                return "no pass is kept in " + folder_.run().string() + "; begin again with " + again + " " +
                       shell_line(command_.again(false));
            return "kept in " + folder_.run().string() + ": " + render_words(folder_.run()) + "; go on with " + again +
                   " resume " + shell_quoted(folder_.run().string());
        }
        return "finished ones are kept in " + folder_.run().string() + "; go on with " + again + " " +
               shell_line(command_.words);
    }

    const LaunchOptions& options_;
    LaunchedCommand command_;
    const std::string launch_ = random_name();
    const Timer clock_;
    LaunchSignals signals_;
    LaunchPlanner planner_;
    LaunchFolder folder_;
    std::unique_ptr<AttemptFolders> folders_;
    LaunchOutput output_;
    std::optional<LifeStatus> seen_;  ///< last heartbeat of the attempt
    std::string not_started_;         ///< reason why the attempt could not be started; "" if it was
    std::string start_trouble_;       ///< that reason if it is a disk's, until it is reported
    bool started_ = false;            ///< whether any attempt was started
    bool was_empty_ = false;          ///< whether the run directory was, so that all in it is of the attempts
    std::unique_ptr<ChildProcess> child_;
    std::unique_ptr<HostKeys> host_keys_;
    Supervisor supervisor_;
};

}  // namespace

int run_launch(const LaunchOptions& options, LaunchedCommand command) {
    ignore_broken_pipes();
    return LaunchRun(options, std::move(command)).run();
}

}  // namespace treefarm
