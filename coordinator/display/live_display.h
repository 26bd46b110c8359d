// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "coordinator/display/display_client.h"
#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// A render's image in a viewer while it renders: after each pass, and within passes so seldom that it takes half a
/// percent of the time.
class LiveDisplay {
  public:
    /// `server`: as --display-server names it; "": nothing is shown. `name`: of the image in the viewer.
    LiveDisplay(const std::string& server, const std::string& name);

    void show(const RenderResult& finished);
    /// With what has come of the pass in hand; `now`: seconds of the render's clock.
    void show(std::span<const PixelEstimate> film, int width, int height, double now);
    std::vector<std::string> take_news();

  private:
    std::unique_ptr<DisplayClient> client_;  ///< nullptr: none
    std::shared_ptr<const CombinedImage> newest_ = std::make_shared<CombinedImage>();
    std::uint32_t newest_spp_ = 0;
    double next_ = 0;  ///< not before
};

}  // namespace treefarm
