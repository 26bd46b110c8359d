// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

#include "coordinator/render/render.h"
#include "coordinator/words/progress.h"

namespace treefarm {

/// Command and console of a series of renders.
struct SeriesContext {
    RenderOrigin origin;
    RenderWorkers workers;    ///< at the other end of a channel
    RenderObserver observer;  ///< of each render
    ConsolePtr console;       ///< for the progress of the series
    Log log;                  ///< of the series
    bool overwrite = false;   ///< other results in its folder may be replaced
};

/// Observer that also shows the render's progress on a console; both arguments must outlive it.
RenderObserver shown_by(Progress& progress, const RenderObserver& observer);

/// Series of renders within one allocation: workers stay, and are told to join the next job.
class RenderSeries {
  public:
    explicit RenderSeries(const SeriesContext& context) : context_(context) {}

    /// Runs the request in a folder, whose log.txt has the details; the console shows the progress in the form `frame`.
    /// `pass`: RenderObserver::pass. Throws InputError as treefarm::render() does.
    RenderOutcome render(RenderRequest& request, const std::filesystem::path& folder, StatusFrame frame,
                         const decltype(RenderObserver::pass)& pass = {});

    /// Workers that were lost and are not back.
    const std::set<int>& lost_peers() const { return turn_.absent; }
    /// Whether no worker is left.
    bool has_lost_all() const;

  private:
    const SeriesContext& context_;
    JobTurn turn_;
};

}  // namespace treefarm
