// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "coordinator/render_run.h"

namespace treefarm {

/// How a series of renders was started, and where it speaks.
struct SeriesContext {
    std::string command;  ///< as it was typed
    Fingerprint build;    ///< of this program
    ConsolePtr console;
    Verbosity verbosity = Verbosity::normal;
    bool overwrite = false;                      ///< other results that its folder holds
    Log log;                                     ///< on that console
    std::shared_ptr<SignOfLife> life = nullptr;  ///< that a supervisor watches
};

/// Renders one after another in one allocation: workers stay, and are told to join the next one.
class RenderSeries {
  public:
    RenderSeries(Channel& channel, const SeriesContext& context, const std::function<bool()>& interrupted)
        : channel_(channel), context_(context), interrupted_(interrupted) {}

    /// Runs the request in a folder. A series has a line per render on the console: what happens within stands in the
    /// folder's log.txt. Throws InputError as run_render() does.
    RenderOutcome render(RenderRequest& request, const std::filesystem::path& folder);

    /// Workers that were given up and are not back.
    const std::set<int>& lost_peers() const { return turn_.absent; }
    /// Nobody is left to render with.
    bool has_lost_all() const;

  private:
    Channel& channel_;
    const SeriesContext& context_;
    const std::function<bool()>& interrupted_;
    JobTurn turn_;
};

}  // namespace treefarm
