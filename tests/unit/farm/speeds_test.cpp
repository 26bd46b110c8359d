// SPDX-License-Identifier: Apache-2.0
// How work is handed out by speed, on a simulated clock: workers of given speeds, results now and then, copies at the
// end, as the farm does it.
#include "coordinator/farm/speeds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <limits>

#include "coordinator/farm/result_pace.h"

namespace treefarm {
namespace {

constexpr double kPathsPerSecond = 1e6;  // of a worker of speed 1
constexpr double kUpdateSeconds = 1.5, kLook = 0.02;

/// A worker of one thread. `speed(t)`: of kPathsPerSecond, at the time t.
struct SimulatedWorker {
    std::function<double(double)> speed;
    std::deque<WorkUnit> queue;
    std::vector<WorkUnit> finished;
    double left = 0;  ///< paths of the front unit that are still to be traced
    double sent = 0;
    bool told_end = false;
    WorkerSpeed measured;
};

/// Time of a pass over the ideal: of all workers without a pause.
class Simulation {
  public:
    explicit Simulation(std::vector<std::function<double(double)>> speeds) {
        for (auto& speed : speeds)
            workers_.emplace_back().speed = speed;
    }

    /// A pass of so many seconds of one worker of speed 1. Speeds that were measured stay for the next.
    double pass(double core_seconds) {
        const auto side = static_cast<int>(std::lround(std::sqrt(core_seconds * kPathsPerSecond / 64)));
        Ledger ledger({.index = 0, .spp = 64}, side, side, 32);
        const double all = static_cast<double>(ledger.waiting_paths());
        double ideal_paths = 0, ideal = 0, ended = -1;
        const double begin = now_;
        for (SimulatedWorker& w : workers_) {
            w.queue.clear();
            w.finished.clear();
            w.left = 0;
            w.told_end = false;
            w.sent = now_;
        }
        while (!ledger.complete()) {
            if (now_ > begin + 1000) return std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < workers_.size(); ++i)
                step(ledger, static_cast<int>(i), ended);
            for (const SimulatedWorker& w : workers_)
                ideal_paths += w.speed(now_) * kPathsPerSecond * kStep;
            now_ += kStep;
            if (ideal == 0 && ideal_paths >= all) ideal = now_ - begin;
        }
        for (SimulatedWorker& w : workers_)
            w.measured.deliver(now_, 0, false);
        return (now_ - begin) / (ideal > 0 ? ideal : now_ - begin);
    }

  private:
    static constexpr double kStep = 0.002;

    void step(Ledger& ledger, int number, double& ended) {
        SimulatedWorker& w = workers_[static_cast<std::size_t>(number)];
        const double speed = w.speed(now_);
        if (speed == 0) return;  // it neither traces nor speaks
        double paths = speed * kPathsPerSecond * kStep;
        while (paths > 0 && !w.queue.empty()) {
            if (w.left == 0) w.left = static_cast<double>(ledger.paths(w.queue.front()));
            const double traced = std::min(paths, w.left);
            w.left -= traced;
            paths -= traced;
            if (w.left > 0) break;
            w.finished.push_back(w.queue.front());
            w.queue.pop_front();
        }
        const bool at_end = w.told_end && w.queue.empty();
        if (!w.finished.empty() && (at_end || now_ - w.sent >= kUpdateSeconds)) send(ledger, number);
        if (w.queue.size() < 2) serve(ledger, number, ended);
    }

    void send(Ledger& ledger, int number) {
        SimulatedWorker& w = workers_[static_cast<std::size_t>(number)];
        const Verdict verdict = ledger.accept(number, w.finished);
        EXPECT_NE(verdict, Verdict::protocol_error);
        std::uint64_t paths = 0;
        for (const WorkUnit& unit : w.finished)
            paths += verdict == Verdict::accepted ? ledger.paths(unit) : 0;
        if (verdict == Verdict::late) ledger.drop(number, w.finished);
        if (paths > 0 || ledger.outstanding(number) == 0)
            w.measured.deliver(now_, paths, ledger.outstanding(number) > 0);
        w.finished.clear();
        w.sent = now_;
        for (std::size_t other = 0; other < workers_.size(); ++other)
            for (const WorkUnit& unit : ledger.take_superseded(static_cast<int>(other)))
                if (auto& queue = workers_[other].queue; !queue.empty() && queue.front() != unit)
                    std::erase(queue, unit);
    }

    void serve(Ledger& ledger, int number, double& ended) {
        SimulatedWorker& w = workers_[static_cast<std::size_t>(number)];
        std::map<int, WorkerRate> rates;
        for (std::size_t i = 0; i < workers_.size(); ++i)
            rates[static_cast<int>(i)] =
                worker_rate(workers_[i].measured, 1, ledger.outstanding_paths(int(i)), kUpdateSeconds, now_);
        const Speeds speeds(rates);
        std::uint64_t queued = 0;
        for (std::size_t i = 1; i < w.queue.size(); ++i)
            queued += ledger.paths(w.queue[i]);
        std::vector<WorkUnit> units;
        if (ledger.waiting() > 0) {
            units = ledger.issue(number, speeds.portion(number, 8, queued, ledger.waiting_paths()));
            if (!units.empty()) w.told_end = false;
        } else if (w.queue.empty() && w.finished.empty() && now_ - ended > 0.05) {
            units = ledger.issue_copies(number, 1, [&](int holder, const WorkUnit& unit) {
                return speeds.gain(number, ledger.paths(unit), holder, ledger.outstanding_paths(holder));
            });
        }
        w.queue.insert(w.queue.end(), units.begin(), units.end());
        if (!units.empty()) w.measured.begin(now_);
        if (ledger.waiting() == 0 && !w.told_end) {
            ended = now_;
            for (std::size_t other = 0; other < workers_.size(); ++other) {
                SimulatedWorker& told = workers_[other];
                if (!told.told_end && !told.finished.empty() && told.speed(now_) > 0)
                    send(ledger, static_cast<int>(other));
                told.told_end = true;
            }
        }
    }

    std::vector<SimulatedWorker> workers_;
    double now_ = 0;
};

std::function<double(double)> steady(double speed) {
    return [=](double) { return speed; };
}

/// Stands still for 0.9 s of each second.
double duty(double t) {
    return t - std::floor(t) < 0.1 ? 1.0 : 0.0;
}

struct Case {
    const char* name;
    std::vector<std::function<double(double)>> speeds;
    double core_seconds;
    double most;  ///< of the ideal time
};

class WorkDistribution : public testing::TestWithParam<Case> {};

TEST_P(WorkDistribution, IsNearTheIdeal) {
    Simulation simulation(GetParam().speeds);
    simulation.pass(4.0);  // nobody knows anybody's speed yet
    double sum = 0;
    for (int pass = 0; pass < 4; ++pass)
        sum += simulation.pass(GetParam().core_seconds);
    EXPECT_LT(sum / 4, GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(
    Farms, WorkDistribution,
    testing::Values(Case{"alike", {steady(1), steady(1), steady(1), steady(1)}, 8, 1.06},
                    Case{"one_of_two_slow", {steady(1), steady(0.1)}, 6.4, 1.1},
                    Case{"one_of_four_slow", {steady(1), steady(1), steady(1), steady(0.1)}, 8, 1.1},
                    Case{"one_of_two_stops", {steady(1), duty}, 6.4, 1.15},
                    Case{"one_of_four_stops", {steady(1), steady(1), steady(1), duty}, 20, 1.15},
                    Case{"one_of_sixteen_slow",
                         {steady(1), steady(1), steady(1), steady(1), steady(1), steady(1), steady(1), steady(1),
                          steady(1), steady(1), steady(1), steady(1), steady(1), steady(1), steady(1), steady(0.1)},
                         32,
                         1.15},
                    Case{"one_stands_still",
                         {steady(1), steady(1), steady(1), [](double t) { return t < 3 ? 1.0 : 0.0; }},
                         20,
                         1.15}),
    [](const auto& info) { return info.param.name; });

TEST(WorkerSpeed, IsKnownAfterAResultAndCountsNoTimeWithoutUnits) {
    WorkerSpeed measured;
    measured.begin(0.0);
    EXPECT_FALSE(measured.paths_per_second());
    measured.deliver(1.0, 1000, false);
    EXPECT_DOUBLE_EQ(*measured.paths_per_second(), 1000);
    measured.begin(3.0);
    measured.deliver(4.0, 1000, true);
    EXPECT_DOUBLE_EQ(*measured.paths_per_second(), 1000) << "who has no work is not slow";
    measured.deliver(6.0, 0, false);
    EXPECT_DOUBLE_EQ(*measured.paths_per_second(), 500) << "half of it after the half-life";
    measured.deliver(9.0, 0, false);
    EXPECT_DOUBLE_EQ(*measured.paths_per_second(), 500) << "it had no units";
}

TEST(WorkerSpeed, IsNoMoreThanWhatAnOverdueWorkerCanHave) {
    WorkerSpeed measured;
    measured.begin(0.0);
    EXPECT_EQ(worker_rate(measured, 2, 600, 1.5, 1.0).most, std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(worker_rate(measured, 2, 600, 1.5, 3.5).most, 300);
    measured.deliver(4.0, 8000, true);
    EXPECT_DOUBLE_EQ(*worker_rate(measured, 2, 600, 1.5, 4.0).speed, 2000);
    EXPECT_EQ(worker_rate(measured, 2, 600, 1.5, 5.0).most, std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(worker_rate(measured, 2, 600, 1.5, 11.5).most, 100);
}

/// A deadline from measured rates: a copy is made once the wait is longer than twice its time.
TEST(Speeds, AnOverdueUnitIsCopiedWhateverIsKnownOfItsHolder) {
    const auto gain = [](std::optional<double> speed, unsigned threads, double overdue) {
        WorkerRate holder{threads, speed, 1000 / overdue};
        return Speeds({{1, holder}, {2, {2, 1000.0}}}).gain(2, 1000, 1, 1000);
    };
    for (const unsigned threads : {1u, 65536u})
        for (const std::optional<double> speed : {std::optional<double>(), std::optional<double>(1e12)}) {
            EXPECT_EQ(gain(speed, threads, 1.9), 0) << threads;
            EXPECT_GT(gain(speed, threads, 2.1), 0) << threads;
        }
    // Two workers with a stuck thread each help one another.
    const Speeds both({{1, {2, 1000.0, 100 / 1.0}}, {2, {2, 1000.0, 100 / 0.9}}, {3, {2, 1000.0, 600}}});
    EXPECT_TRUE(both.is_overdue(1));
    EXPECT_TRUE(both.is_overdue(2));
    EXPECT_FALSE(both.is_overdue(3)) << "units may take longer than was thought";
    EXPECT_GT(both.gain(1, 100, 2, 100), 0);
    EXPECT_GT(both.gain(2, 100, 1, 100), 0);
    const Speeds nothing_known({{1, {1, std::nullopt, 1000 / 0.2}}, {2, {2, std::nullopt}}});
    EXPECT_GT(nothing_known.gain(2, 1000, 1, 1000), 0);
}

TEST(Speeds, PortionsAreForTwoSecondsOrAQuarterOfOnesPart) {
    const Speeds speeds({{1, {2, 1000.0}}, {2, {2, 3000.0}}, {3, {4, std::nullopt}}});
    EXPECT_EQ(speeds.portion(1, 9, 0, 1'000'000).paths, 2000u);
    EXPECT_EQ(speeds.portion(1, 9, 500, 1'000'000).paths, 1500u);
    EXPECT_EQ(speeds.portion(1, 9, 5000, 1'000'000).units, 0u) << "it has enough";
    EXPECT_EQ(speeds.portion(3, 9, 0, 1'000'000).paths, 8000u) << "as fast as others by its threads";
    EXPECT_EQ(speeds.portion(2, 9, 0, 8000).paths, 8000u * 3 / 8 / 4);
    EXPECT_EQ(speeds.portion(2, 9, 0, 8000).piece, 8000u * 3 / 8 / 4 / 2);
    EXPECT_GE(speeds.portion(1, 9, 0, 1).paths, 1u) << "who has nothing gets something";
    EXPECT_EQ(speeds.gain(2, 300, 1, 1000), 0.9);
    EXPECT_EQ(speeds.gain(2, 3000, 2, 3000), 0);
}

TEST(Speeds, WhoStandsStillIsHelpedByWhomNobodyKnows) {
    const Speeds unknown({{1, {2, std::nullopt}}, {2, {2, std::nullopt}}}),
        still({{1, {2, 0.0}}, {2, {2, std::nullopt}}});
    EXPECT_EQ(unknown.gain(2, 300, 1, 1000), 0) << "who is slow is not known yet";
    EXPECT_GT(still.gain(2, 300, 1, 1000), 0);
}

TEST(ResultPace, SplatsToALargeFilmAreSentMoreRarely) {
    EXPECT_EQ(result_seconds(1.5, 0, 1000), 1.5) << "none";
    EXPECT_EQ(result_seconds(1.5, 512 * 512, 2), 1.5) << "19 MB are little";
    EXPECT_NEAR(result_seconds(1.5, 1920 * 1080, 20), 42.5, 0.5);
    EXPECT_EQ(result_seconds(60, 1920 * 1080, 20), 60);
}

}  // namespace
}  // namespace treefarm
