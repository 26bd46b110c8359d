// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/launch/supervisor.h"

namespace treefarm::test {

/// Simulated environment of a supervisor, with one attempt at a time and a record of the supervisor's actions.
class LaunchWorld {
  public:
    explicit LaunchWorld(SupervisorLimits limits = {})
        : supervisor_(limits,
                      {[this](int number) { begin(number); }, [this] { note("stop"); },
                       [this](const LifeStatus& status) { note("dump " + std::to_string(status.pid)); },
                       [this] { note("terminate"); }, [this] { note("kill"); },
                       [this](const std::string& words) { said.push_back(words); }},
                      [](int number) { return "run." + std::to_string(number); }) {}

    /// Advances the clock once; the coordinator may act in between.
    void step(double seconds = 1.0) {
        now += seconds;
        if (!end)
            end = supervisor_.step(
                {now, running, not_started, disk, readable, coordinator_gone, status, summary, checkpoint});
    }
    /// Advances `seconds` seconds, and calls `life` in each.
    void pass(
        double seconds, const std::function<void()>& life = [] {}) {
        for (double t = 0; t < seconds && !end; ++t) {
            life();
            step();
        }
    }
    void live() {
        if (status) ++status->beat;
    }
    void work() {
        live();
        if (status) ++status->progress;
    }
    /// First heartbeat of the coordinator.
    void appear(LifePhase phase = LifePhase::pass, std::uint32_t pass = 2) {
        status = LifeStatus{};
        status->attempt = "run." + std::to_string(attempt);
        status->phase = phase;
        status->pass = pass;
        status->host = "node1";
        status->pid = 42;
    }
    void die() { running = false; }
    /// Exit code of the launch after the end of the attempt's processes; no value if it continues.
    std::optional<int> code_after_death() {
        die();
        step();
        return end ? std::optional(end->code) : std::nullopt;
    }
    /// Reports the coordinator's exit code; all its processes leave.
    void finish(int code) {
        if (!status) appear();
        status->code = code;
        running = false;
    }
    /// Starts an attempt and brings it to a pass.
    void run_to_pass(std::uint32_t pass = 2) {
        while (!running && !end)
            step();
        appear(LifePhase::pass, pass);
        step();
    }
    bool did(const std::string& deed) const { return std::find(deeds.begin(), deeds.end(), deed) != deeds.end(); }
    std::string last_said() const { return said.empty() ? "" : said.back(); }
    void stop() { supervisor_.ask_to_stop(); }

    double now = 0;
    bool running = false, readable = true, coordinator_gone = false;
    std::string not_started;  ///< reason why attempts cannot be started; "": they can
    std::string disk;         ///< reason why no file can be written; "": they can
    int attempt = 0;
    std::optional<LifeStatus> status;
    std::optional<int> summary;
    std::uint64_t checkpoint = 0;
    std::vector<std::string> deeds, said;
    std::vector<double> starts;
    std::optional<SupervisorEnd> end;

  private:
    void begin(int number) {
        attempt = number;
        running = not_started.empty();
        summary.reset();
        starts.push_back(now);
        note("start");
    }
    void note(const std::string& deed) { deeds.push_back(deed); }

    Supervisor supervisor_;
};

}  // namespace treefarm::test
