// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render_series.h"

#include <algorithm>

namespace treefarm {

RenderOutcome RenderSeries::render(RenderRequest& request, const std::filesystem::path& folder) {
    request.job.output.directory = folder.string();
    request.command = context_.command;
    request.console = context_.console;
    request.verbosity = context_.verbosity == Verbosity::verbose ? Verbosity::verbose : Verbosity::quiet;
    request.life = context_.life;
    ++turn_.number;
    request.turn = turn_;
    RenderOutcome outcome = run_render(channel_, request, interrupted_);
    turn_.absent = outcome.lost_peers;
    turn_.left = outcome.left_peers;
    if (context_.life && outcome.state == RunState::done) context_.life->finish_render();
    return outcome;
}

bool RenderSeries::has_lost_all() const {
    const std::vector<int> peers = channel_.peers();
    return std::all_of(peers.begin(), peers.end(),
                       [&](int peer) { return turn_.absent.contains(peer) || turn_.left.contains(peer); });
}

}  // namespace treefarm
