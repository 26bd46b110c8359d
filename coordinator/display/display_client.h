// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "coordinator/display/display_server.h"

namespace treefarm {

/// Time limits of the connection to a display server, seconds.
struct DisplayLimits {
    double connect = 2.0;
    double stall = 10.0;  ///< without any byte accepted
    double retry = 10.0;  ///< between a failure and the next attempt
    double last = 2.0;    ///< at the end, for the newest image
};

/// Client of a viewer with tev's protocol, in a thread of its own. The render never waits for the viewer: only the
/// newest unsent image is kept, and a missing, slow or closed viewer is reported once.
class DisplayClient {
  public:
    using Make = std::function<RgbImage()>;  ///< makes the image; called by the client's thread

    /// `name`: name of the image in the viewer.
    DisplayClient(const DisplayServer& server, const std::string& name, const DisplayLimits& limits = {});
    /// Waits for the newest image to be sent, up to DisplayLimits::last.
    ~DisplayClient();
    DisplayClient(const DisplayClient&) = delete;
    DisplayClient& operator=(const DisplayClient&) = delete;

    /// Replaces the waiting image.
    void show(Make make);
    /// Whether no image waits or is being sent.
    bool idle() const;
    /// Core-seconds in which the last image was made and sent; 0 before the first.
    double core_seconds() const;
    /// News since the last call: the reason why nothing is shown, reported once.
    std::vector<std::string> take_news();

  private:
    struct Shared;
    static void work(const std::shared_ptr<Shared>& shared);

    /// Shared with the thread: during a name look-up it cannot be stopped, and outlives this object.
    std::shared_ptr<Shared> shared_;
    const double last_seconds_;
};

}  // namespace treefarm
