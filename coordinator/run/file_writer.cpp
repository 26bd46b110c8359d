// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/file_writer.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "common/base/files/atomic_file.h"

namespace treefarm {

namespace {

constexpr double kRetrySeconds = 1.0;

/// Kinds of trouble that are no errno.
constexpr int kNoMemory = -1, kOther = -2;

}  // namespace

void FileWriter::put(const std::string& name, Write write, Pace pace) {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[name];
    slot.write = std::move(write);
    slot.pace = pace;
    changed_.notify_one();
}

void FileWriter::forget(const std::string& name) {
    std::unique_lock lock(mutex_);
    if (const auto slot = slots_.find(name); slot != slots_.end()) slot->second.write = {};
    idle_.wait(lock, [&] { return writing_ != name; });
}

std::vector<std::string> FileWriter::take_news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

std::vector<std::string> FileWriter::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        changed_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
    std::vector<std::string> unwritten;
    for (const auto& [name, slot] : slots_)
        if (slot.write) unwritten.push_back(name);
    return unwritten;
}

FileWriter::Slots::iterator FileWriter::next_due() {
    auto best = slots_.end();
    for (auto slot = slots_.begin(); slot != slots_.end(); ++slot)
        if (slot->second.write && (best == slots_.end() || slot->second.due < best->second.due)) best = slot;
    return best;
}

void FileWriter::work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        const auto slot = next_due();
        if (slot == slots_.end())
            changed_.wait(lock);
        else if (const double wait = slot->second.due - clock_.seconds(); wait > 0)
            changed_.wait_for(lock, std::chrono::duration<double>(wait));
        else
            run(slot, lock);
    }
}

void FileWriter::run(Slots::iterator slot, std::unique_lock<std::mutex>& lock) {
    Write write = std::exchange(slot->second.write, {});
    writing_ = slot->first;
    lock.unlock();
    const Timer timer;
    int kind = 0;
    std::string message;
    try {
        write();
    } catch (const FileError& error) {
        kind = error.code();
        message = error.what();
    } catch (const std::bad_alloc&) {
        kind = kNoMemory;
        message = slot->first + ": not enough memory to write it; render a smaller image";
    } catch (const std::exception& error) {
        kind = kOther;
        message = error.what();
    }
    const double seconds = timer.seconds();
    if (message.empty()) write = {};  // an image may be what it holds: not to be freed under the lock
    lock.lock();
    writing_.clear();
    idle_.notify_all();
    Slot& done = slot->second;
    done.failed = !message.empty();
    if (!done.failed) {
        done.due = clock_.seconds() + std::max(done.pace.least, done.pace.multiple * seconds);
        return tell_recovery();
    }
    if (!done.write) done.write = std::move(write);
    done.due = clock_.seconds() + std::max(kRetrySeconds, done.pace.multiple * seconds);
    tell_failure(kind, message);
}

void FileWriter::tell_failure(int kind, const std::string& message) {
    if (!reported_.insert(kind).second) return;
    trouble_ = true;
    news_.push_back(message + "; the render goes on, and it is tried again each second");
}

void FileWriter::tell_recovery() {
    const bool failing =
        std::any_of(slots_.begin(), slots_.end(), [](const auto& entry) { return entry.second.failed; });
    if (!trouble_ || failing) return;
    trouble_ = false;
    news_.emplace_back("all files are written again");
}

}  // namespace treefarm
