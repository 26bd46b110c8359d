// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/reading_notice.h"

#include <chrono>
#include <utility>

#include "common/base/text/duration_text.h"

namespace treefarm {

namespace {

constexpr std::chrono::duration<double> kLiveDelay(1.0), kLineDelay(10.0), kTick(0.5);

}  // namespace

Status reading_status(const std::string& name, double seconds) {
    Status status;
    status.fields = {"reading " + name, rough_duration_text(seconds) + " so far"};
    status.line = join_fields(status.fields);
    return status;
}

ReadingNotice::ReadingNotice(ConsolePtr console, std::string name)
    : console_(std::move(console)), name_(std::move(name)), thread_([this] { run(); }) {}

ReadingNotice::~ReadingNotice() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    over_.notify_one();
    thread_.join();
    console_->end_status();
}

void ReadingNotice::run() {
    const Timer clock;
    std::unique_lock lock(mutex_);
    for (auto wait = console_->kind().live ? kLiveDelay : kLineDelay;
         !over_.wait_for(lock, wait, [&] { return done_; }); wait = kTick)
        console_->status(reading_status(name_, clock.seconds()));
}

}  // namespace treefarm
