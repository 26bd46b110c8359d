// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "coordinator/display/display_client.h"
#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// Display of a render in progress in a viewer: after each pass, and within passes so rarely that it costs half a
/// percent of the time.
class LiveDisplay {
  public:
    /// `server`: value of --display-server; "": nothing is shown. `name`: name of the image in the viewer.
    LiveDisplay(const std::string& server, const std::string& name);

    void show(const RenderResult& finished);
    /// Shows the image with the results so far of the present pass; `now`: seconds of the render's clock.
    void show(std::span<const PixelEstimate> film, int width, int height, double now);
    std::vector<std::string> take_news();

  private:
    std::unique_ptr<DisplayClient> client_;  ///< nullptr: no display
    std::shared_ptr<const CombinedImage> newest_ = std::make_shared<CombinedImage>();
    std::uint32_t newest_spp_ = 0;
    double next_ = 0;  ///< earliest time of the next image
};

}  // namespace treefarm
