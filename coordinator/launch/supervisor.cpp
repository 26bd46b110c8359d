// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/supervisor.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "coordinator/words/pass_text.h"

namespace treefarm {

namespace {

/// Seconds between two steps above which the supervisor itself was stopped, and could not see a heartbeat.
constexpr double kLongestStep = 5.0;

constexpr int kFailed = 1, kBadInput = 2, kInterrupted = 3;

}  // namespace

std::string life_stage(const std::optional<LifeStatus>& status) {
    if (!status) return "the start, before any sign of life";
    switch (status->phase) {
        case LifePhase::start:
            return "the start";
        case LifePhase::scene:
            return "reading the input";
        case LifePhase::gather:
            return "gathering workers";
        case LifePhase::write:
        case LifePhase::end:
            return "writing the result";
        case LifePhase::pass:
            return pass_name(status->pass, 0);
        case LifePhase::combine:
            return "combining " + pass_name(status->pass, 0);
    }
    return "";
}

Supervisor::Supervisor(SupervisorLimits limits, SupervisorActions actions, std::function<std::string(int)> name)
    : limits_(limits),
      actions_(std::move(actions)),
      name_(std::move(name)),
      restarts_(limits.restarts, limits.attempts) {}

void Supervisor::ask_to_stop() {
    ++stops_;
}

std::optional<SupervisorEnd> Supervisor::step(const Sight& sight) {
    forgive_gap(sight.now);
    if (state_ == State::waiting) {
        if (stops_ > 0) return SupervisorEnd{kInterrupted, "interrupted", attempt_ > 0};
        return start_when_due(sight);
    }
    look(sight);
    if (!sight.running) return gone(sight);
    if (stops_ > heeded_stops_) push_stop(sight.now);
    if (state_ == State::running)
        watch(sight);
    else if (state_ == State::stopping)
        watch_stop(sight);
    else if (state_ == State::terminating && sight.now - acted_at_ >= limits_.terminate) {
        state_ = State::killed;
        actions_.kill();
    }
    return std::nullopt;
}

/// Excuses the silence of a gap in which the supervisor itself, or its host, was stopped.
void Supervisor::forgive_gap(double now) {
    const double gap = now - std::exchange(last_step_, now);
    if (gap <= kLongestStep) return;
    for (double* time : {&began_, &beat_at_, &progress_at_, &phase_at_, &acted_at_})
        *time += gap;
    if (code_at_) *code_at_ += gap;
}

void Supervisor::start(double now) {
    ++attempt_;
    own_.reset();
    code_at_.reset();
    why_.clear();
    told_unreadable_ = false;
    began_ = beat_at_ = progress_at_ = phase_at_ = now;
    state_ = State::running;
    actions_.start(attempt_);
}

/// Starts the next attempt once files can be written; the first one may fail and say why.
std::optional<SupervisorEnd> Supervisor::start_when_due(const Sight& sight) {
    if (sight.now < due_) return std::nullopt;
    if (attempt_ > 0 && !sight.disk.empty()) {
        if (sight.now - due_ > limits_.disk_all)
            return SupervisorEnd{
                kFailed,
                fmt::format("the disk has taken no files for {:.0f} h: {}", limits_.disk_all / 3600, sight.disk), true};
        if (std::exchange(told_disk_, sight.disk) != sight.disk) actions_.say("waiting for the disk: " + sight.disk);
        return std::nullopt;
    }
    start(sight.now);
    return std::nullopt;
}

/// Reads the heartbeat.
void Supervisor::look(const Sight& sight) {
    const double now = sight.now;
    if (!sight.readable) {  // no kill without evidence
        if (!std::exchange(told_unreadable_, true)) actions_.say("the sign of life cannot be read: its age is ignored");
        began_ = beat_at_ = progress_at_ = now;
    }
    if (code(sight) && !code_at_) code_at_ = now;
    if (!sight.status || sight.status->attempt != name_(attempt_)) return;
    const LifeStatus& status = *sight.status;
    told_disk_.clear();
    if (!own_ || status.beat != own_->beat) beat_at_ = now;
    if (!own_ || status.progress != own_->progress || status.phase != own_->phase) {
        if (own_) {
            double& longest = longest_[static_cast<std::size_t>(own_->phase)];
            longest = std::max(longest, now - progress_at_);
        }
        progress_at_ = now;
    }
    own_ = status;
}

/// Exit code of this attempt, from the coordinator's heartbeat or its summary.
std::optional<int> Supervisor::code(const Sight& sight) const {
    if (sight.status && sight.status->attempt == name_(attempt_) && sight.status->code) return sight.status->code;
    return sight.summary;
}

double Supervisor::stall_limit() const {
    return std::max(limits_.stall, limits_.stall_multiple * longest_[static_cast<std::size_t>(own_->phase)]);
}

void Supervisor::watch(const Sight& sight) {
    const double now = sight.now;
    if (code_at_) {
        if (now - std::max(*code_at_, beat_at_) > limits_.leave || now - *code_at_ > limits_.leave_all)
            end_attempt(now, "the render has ended, but its launcher still runs: it is ended");
        return;
    }
    if (!own_) {
        if (now - began_ > limits_.start)
            end_attempt(now, fmt::format("no sign of life within {:.0f} s", limits_.start));
    } else if (sight.coordinator_gone) {
        end_attempt(now, "the coordinator is gone");
    } else if (now - beat_at_ > limits_.beat) {
        end_attempt(now, fmt::format("no sign of life for {:.0f} s", now - beat_at_));
    } else if (now - progress_at_ > stall_limit()) {
        actions_.dump(*own_);
        end_attempt(now, fmt::format("no progress for {:.0f} s", now - progress_at_));
    }
}

/// Watches an attempt that was told to stop: outside of a pass it has unlimited time while it makes progress.
void Supervisor::watch_stop(const Sight& sight) {
    if (code_at_ || sight.coordinator_gone) return watch(sight);
    const bool writes = own_ && own_->phase != LifePhase::pass;
    const double still = sight.now - std::max(acted_at_, writes ? progress_at_ : 0.0);
    if (still > limits_.stop) end_attempt(sight.now, fmt::format("it has not stopped for {:.0f} s", still));
}

void Supervisor::end_attempt(double now, const std::string& why) {
    actions_.say(why);
    why_ = why;
    stage_ = life_stage(own_);
    state_ = State::terminating;
    acted_at_ = now;
    actions_.terminate();
}

void Supervisor::push_stop(double now) {
    const bool first = heeded_stops_ == 0;
    heeded_stops_ = stops_;
    if (state_ == State::terminating || state_ == State::killed) return;
    // Before its first heartbeat a process does not handle SIGUSR1, and has nothing to write.
    if (!first || !own_) return end_attempt(now, first ? "stopping" : "stopping at once: unwritten results are lost");
    actions_.say("stopping: writing the finished passes; a second signal stops at once");
    state_ = State::stopping;
    acted_at_ = now;
    actions_.ask_to_stop();
}

std::optional<SupervisorEnd> Supervisor::gone(const Sight& sight) {
    const std::optional<int> known = code(sight);
    const bool stood_still = state_ == State::terminating || state_ == State::killed;
    const bool by_launcher = own_ && own_->ended_by_launcher;
    const bool refused_by_disk = known == kBadInput && attempt_ > 1 && !sight.disk.empty();
    // An attempt ended for its silence, or by mpirun after losing a host, may report that as a user's interruption.
    if (known && *known != kFailed && !refused_by_disk &&
        !(*known == kInterrupted && (stood_still || by_launcher) && stops_ == 0))
        return SupervisorEnd{*known, "", *known == kInterrupted};
    if (stops_ > 0) return SupervisorEnd{kInterrupted, "interrupted in " + life_stage(own_), true};
    if (!sight.not_started.empty())
        return restart_or_end(sight, "it could not be started (" + sight.not_started + ")", life_stage(own_));
    if (known == kFailed || refused_by_disk) return restart_or_end(sight, "the render failed", life_stage(own_));
    if (!why_.empty()) return restart_or_end(sight, why_, stage_);
    if (by_launcher) return restart_or_end(sight, "the launcher ended the render", life_stage(own_));
    return restart_or_end(sight, "the render's processes are gone", life_stage(own_));
}

std::optional<SupervisorEnd> Supervisor::restart_or_end(const Sight& sight, const std::string& why,
                                                        const std::string& stage) {
    AttemptReach reach{sight.checkpoint, 0, 0};
    if (own_) {
        reach.passes = own_->passes;
        reach.renders = own_->renders;
    }
    const std::string host = own_ ? " on " + own_->host : "";
    if (!sight.disk.empty()) {  // says nothing about the render, so that it does not count
        if (std::exchange(told_disk_, sight.disk) != sight.disk)
            actions_.say(fmt::format("{} in {}{}; again when the disk takes files: {}", why, stage, host, sight.disk));
        due_ = sight.now + limits_.disk;
        state_ = State::waiting;
        return std::nullopt;
    }
    if (restarts_.died(reach, stage)) {
        due_ = sight.now + restarts_.pause();
        actions_.say(fmt::format("{} in {}{}; again in {:.0f} s", why, stage, host, restarts_.pause()));
        state_ = State::waiting;
        return std::nullopt;
    }
    const std::string again = restarts_.common_stage();
    const int times = restarts_.in_a_row();
    return SupervisorEnd{kFailed,
                         fmt::format("{} in {}{}; {}", why, stage, host,
                                     times > 1 ? fmt::format("given up after {} attempts in a row without progress{}",
                                                             times, again.empty() ? "" : ", all of which ended there")
                                               : "no restarts are left"),
                         true};
}

}  // namespace treefarm
