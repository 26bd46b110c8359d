// SPDX-License-Identifier: Apache-2.0
#include "cli/observer.h"

#include <vector>

namespace treefarm {

RenderObserver make_observer(const LogOutput& log_output, const std::shared_ptr<SignOfLife>& life) {
    RenderObserver observer;
    observer.message = console_messages("treefarm", log_output.console, log_output.verbosity);
    if (!life) return observer;
    observer.phase = [life](LifePhase phase) { life->enter(phase); };
    observer.progress = [life](const RenderProgress& progress, const Roster& roster) {
        life->see({progress.pass, progress.pass, progress.units + progress.rays});
        life->see_workers([&roster] {
            std::vector<LifeWorker> workers;
            for (const auto& [peer, member] : roster.members())
                workers.push_back({member.hello.host, member.state == MemberState::lost});
            return workers;
        });
    };
    return observer;
}

SeriesContext make_series(const RenderOrigin& origin, const RenderWorkers& workers, const LogOutput& log_output,
                          const Log& log, const std::shared_ptr<SignOfLife>& life) {
    const Verbosity within = log_output.verbosity == Verbosity::verbose ? Verbosity::verbose : Verbosity::quiet;
    SeriesContext series{origin, workers, make_observer({log_output.console, within}, life), log_output.console, log};
    if (life) series.origin.attempt = life->attempt();
    if (life)
        series.observer.end = [life](const RenderOutcome& outcome) {
            if (outcome.state == RunState::done) life->finish_render();
        };
    return series;
}

}  // namespace treefarm
