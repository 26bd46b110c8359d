// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/sign_of_life.h"

#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <utility>

#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "common/base/timer.h"

namespace treefarm {

namespace {

/// Seconds of processor time that count as one step of progress; an idle process does not reach one in minutes.
constexpr double kStepSeconds = 5.0;
constexpr std::uint64_t kStepBytes = std::uint64_t{1} << 20;

/// Bytes that this process has read and written to disks so far; 0 if the kernel does not report it.
std::uint64_t moved_bytes() {
    std::ifstream file("/proc/self/io");
    std::uint64_t sum = 0, number = 0;
    for (std::string name; file >> name >> number;)
        if (name == "rchar:" || name == "write_bytes:") sum += number;
    return sum;
}

/// Writes a line to the error output, which leads to treefarm launch on whatever host; drops it if nobody reads there.
void print_sign(const std::string& line) {
    constexpr int kMilliseconds = 100;
    pollfd output{STDERR_FILENO, POLLOUT, 0};
    if (poll(&output, 1, kMilliseconds) != 1 || (output.revents & POLLOUT) == 0) return;
    if (::write(STDERR_FILENO, line.data(), line.size()) < 0) return;  // the next one comes in a second
}

std::uint64_t effort_so_far() {
    return static_cast<std::uint64_t>(process_cpu_seconds() / kStepSeconds) + moved_bytes() / kStepBytes;
}

}  // namespace

std::string attempt_text(const LifeAttempt& attempt) {
    return attempt.name + ":" + attempt.file.string();
}

LifeAttempt parse_attempt(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return {};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

SignOfLife::~SignOfLife() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        changed_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
}

void SignOfLife::begin() {
    if (thread_.joinable()) return;
    status_.attempt = attempt_.name;
    status_.host = host_name();
    status_.pid = getpid();
    // Signals are handled by the main thread, which may not have blocked them yet: in this thread they would end the
    // process.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { work(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void SignOfLife::enter(LifePhase phase) {
    const std::lock_guard lock(mutex_);
    if (std::exchange(status_.phase, phase) != phase) ++told_;
}

void SignOfLife::see(const Pass& pass) {
    const std::lock_guard lock(mutex_);
    if (pass.work != last_work_ || pass.pass != status_.pass || status_.phase != LifePhase::pass) ++told_;
    last_work_ = pass.work;
    status_.pass = pass.pass;
    status_.passes = pass.passes;
    status_.phase = LifePhase::pass;
}

void SignOfLife::see_workers(const std::function<std::vector<LifeWorker>()>& list) {
    const std::lock_guard lock(mutex_);
    if (has_list_ && listed_ == status_.beat) return;
    has_list_ = true;
    listed_ = status_.beat;
    status_.workers = list();
}

void SignOfLife::finish_render() {
    const std::lock_guard lock(mutex_);
    ++status_.renders;
    ++told_;
}

void SignOfLife::end(int code, bool by_launcher) {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        status_.code = code;
        status_.ended_by_launcher = status_.ended_by_launcher || by_launcher;
        status_.phase = LifePhase::end;
        ++told_;
    }
    write();
}

void SignOfLife::work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        ++status_.beat;
        lock.unlock();
        write();
        lock.lock();
        changed_.wait_for(lock, std::chrono::seconds(1), [this] { return stopping_; });
    }
}

void SignOfLife::write() {
    const std::lock_guard one(file_);  // before the text is made: an older text must not follow a newer one
    const std::uint64_t effort = effort_so_far();
    LifeStatus status;
    {
        const std::lock_guard lock(mutex_);
        // While workers trace, polling them keeps this process busy: that is no progress.
        if (status_.phase != LifePhase::pass) effort_ = effort;
        status_.progress = told_ + effort_;
        status = status_;
    }
    const std::string text = life_status_text(status);
    try {
        write_file_atomically(attempt_.file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                              Outlives::process);
    } catch (const std::exception&) {  // a full disk or a vanished folder does not end a render
        print_sign(life_line(status));
    }
}

}  // namespace treefarm
