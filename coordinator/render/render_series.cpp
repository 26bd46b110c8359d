// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/render_series.h"

#include <algorithm>
#include <utility>

namespace treefarm {

RenderObserver shown_by(Progress& progress, const RenderObserver& observer) {
    RenderObserver both = observer;
    both.phase = [&](LifePhase phase) {
        if (phase == LifePhase::write) progress.clear();  // further lines are the last ones
        if (observer.phase) observer.phase(phase);
    };
    both.progress = [&](const RenderProgress& now, const Roster& workers) {
        progress.update(now);
        if (observer.progress) observer.progress(now, workers);
    };
    return both;
}

RenderOutcome RenderSeries::render(RenderRequest& request, const std::filesystem::path& folder, StatusFrame frame,
                                   const decltype(RenderObserver::pass)& pass) {
    request.content.job.output.directory = folder.string();
    request.workers = context_.workers;
    ++turn_.number;
    request.workers.turn = turn_;
    Progress shown(context_.console, request.content.job.budget, std::move(frame));
    RenderObserver observer = shown_by(shown, context_.observer);
    observer.pass = pass;
    RenderOutcome outcome = treefarm::render(request, observer);
    turn_.absent = outcome.lost_peers;
    turn_.left = outcome.left_peers;
    return outcome;
}

bool RenderSeries::has_lost_all() const {
    const std::vector<int> peers = context_.workers.channel->peers();
    return std::all_of(peers.begin(), peers.end(),
                       [&](int peer) { return turn_.absent.contains(peer) || turn_.left.contains(peer); });
}

}  // namespace treefarm
