// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/speeds.h"

#include <algorithm>
#include <cmath>

namespace treefarm {

namespace {

constexpr double kLeastSpeed = 1.0;   ///< of a worker without progress: it may resume
constexpr double kOverdue = 0.5;      ///< part of its speed below which an overdue worker has stuck threads
constexpr double kHalfLife = 2.0;     ///< of a measured speed, seconds
constexpr double kMostUnknown = 4.0;  ///< limit of an unknown speed, of the fastest: any number of threads is claimed
// Limits of a worker's portion: small, so that the last units of a pass spread over all workers.
constexpr double kMostSeconds = 2.0;  ///< seconds of the worker's time
constexpr double kPart = 0.25;        ///< fraction of its part of the rest
// Least saving of a copy for a second worker: in seconds, and as a multiple of its time for the copy.
constexpr double kCopyGain = 0.1, kCopyRatio = 1.0;

}  // namespace

void WorkerSpeed::begin(double now) {
    if (!since_) since_ = now;
}

void WorkerSpeed::deliver(double now, std::uint64_t paths, bool busy) {
    if (const double seconds = waited(now); seconds > 0) {
        const double kept = speed_ ? std::exp2(-seconds / kHalfLife) : 0.0;
        speed_ = kept * speed_.value_or(0.0) + (1.0 - kept) * static_cast<double>(paths) / seconds;
    }
    since_.reset();
    if (busy) since_ = now;
}

WorkerRate worker_rate(const WorkerSpeed& speed, unsigned threads, std::uint64_t outstanding, double result_seconds,
                       double now) {
    WorkerRate rate{threads, speed.paths_per_second()};
    const double overdue = speed.waited(now) - result_seconds;
    if (overdue > 0) rate.most = static_cast<double>(outstanding) / overdue;
    return rate;
}

Speeds::Speeds(const std::map<int, WorkerRate>& rates) : rates_(rates) {
    double paths = 0, threads = 0;
    for (const auto& [worker, rate] : rates_) {
        if (!rate.speed) continue;
        paths += std::min(*rate.speed, rate.most);
        threads += rate.threads;
        fastest_ = std::max(fastest_, *rate.speed);
    }
    if (threads > 0) per_thread_ = paths / threads;
    for (const auto& [worker, rate] : rates_)
        total_ += speed(worker);
}

/// Paths per second of the threads that deliver; number of threads if no speed is known.
double Speeds::speed_when_it_delivers(int worker) const {
    const auto found = rates_.find(worker);
    if (found == rates_.end()) return kLeastSpeed;
    const WorkerRate& rate = found->second;
    double speed = rate.threads;
    if (rate.speed)
        speed = *rate.speed;
    else if (per_thread_ > 0)
        speed = std::min(rate.threads * per_thread_, kMostUnknown * fastest_);
    return std::max(speed, kLeastSpeed);
}

double Speeds::speed(int worker) const {
    const auto found = rates_.find(worker);
    if (found == rates_.end()) return kLeastSpeed;
    return std::max(std::min(speed_when_it_delivers(worker), found->second.most), kLeastSpeed);
}

bool Speeds::is_overdue(int worker) const {
    const auto found = rates_.find(worker);
    return found != rates_.end() && found->second.most < kOverdue * speed_when_it_delivers(worker);
}

Portion Speeds::portion(int worker, std::size_t credit, std::uint64_t queued, std::uint64_t waiting) const {
    const auto found = rates_.find(worker);
    if (found == rates_.end()) return {};
    const double mine = speed(worker);
    double paths = kPart * static_cast<double>(waiting) * mine / std::max(total_, mine);
    if (per_thread_ > 0) paths = std::min(paths, kMostSeconds * mine);
    const double left = paths - static_cast<double>(queued);
    if (left < 1 && queued > 0) return {};
    const double piece = std::max(paths / found->second.threads, 1.0);
    return {credit, static_cast<std::uint64_t>(std::max(left, 1.0)), static_cast<std::uint64_t>(piece)};
}

double Speeds::gain(int here, std::uint64_t paths, int holder, std::uint64_t outstanding) const {
    const auto known = [&](int worker) {
        const auto found = rates_.find(worker);
        return found != rates_.end() && found->second.speed.has_value();
    };
    const bool waits = rates_.contains(holder) && std::isfinite(rates_.at(holder).most);
    if (per_thread_ == 0 && !known(holder) && !waits) return 0;
    // A worker that finished all before its speed was known is fast.
    const double takes =
        per_thread_ > 0 || known(here) ? static_cast<double>(paths) / speed_when_it_delivers(here) : 0.0;
    const double saved = static_cast<double>(outstanding) / speed(holder) - takes;
    // If both end at the same time, the slower one's whole result is dropped.
    return saved > std::max(kCopyGain, kCopyRatio * takes) ? saved : 0;
}

}  // namespace treefarm
