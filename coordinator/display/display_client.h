// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "coordinator/display/display_server.h"

namespace treefarm {

/// How long a display server is waited for, seconds.
struct DisplayLimits {
    double connect = 2.0;
    double stall = 10.0;  ///< in which it has to take at least something
    double retry = 10.0;  ///< after what went wrong until it is tried again
    double last = 2.0;    ///< at the end, for the newest image
};

/// Shows a render's images in a viewer that speaks tev's protocol, in a thread of its own. Nobody waits for the viewer:
/// of images that it has not got only the newest is kept, and one that is absent, slow or gone is a piece of news,
/// once.
class DisplayClient {
  public:
    using Make = std::function<RgbImage()>;  ///< makes the image; called by the client's thread

    /// `name`: of the image in the viewer.
    DisplayClient(const DisplayServer& server, const std::string& name, const DisplayLimits& limits = {});
    /// Waits for the newest image to be sent, up to DisplayLimits::last.
    ~DisplayClient();
    DisplayClient(const DisplayClient&) = delete;
    DisplayClient& operator=(const DisplayClient&) = delete;

    /// Puts an image in the place of what waits.
    void show(Make make);
    /// Whether nothing waits or is being sent.
    bool idle() const;
    /// Seconds of a core that the last image took to make and to send; 0 before.
    double core_seconds() const;
    /// News since the last call: why nothing is shown, once.
    std::vector<std::string> take_news();

  private:
    struct Shared;
    static void work(const std::shared_ptr<Shared>& shared);

    /// Kept by the thread too: one that looks up a name cannot be stopped, and outlives this.
    std::shared_ptr<Shared> shared_;
    const double last_seconds_;
};

}  // namespace treefarm
