// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/live_display.h"

#include <algorithm>
#include <thread>

#include "common/base/timer.h"
#include "coordinator/display/preview.h"

namespace treefarm {

namespace {

/// Least interval of images within a pass, as a multiple of one image's cost in seconds of all processors.
constexpr double kInterval = 200.0;
constexpr double kLeastSeconds = 1.0;

}  // namespace

LiveDisplay::LiveDisplay(const std::string& server, const std::string& name) {
    if (!server.empty()) client_ = std::make_unique<DisplayClient>(parse_display_server(server), name);
}

void LiveDisplay::show(const RenderResult& finished) {
    if (!client_) return;
    newest_ = finished.image;
    newest_spp_ = finished.spp;
    client_->show([image = newest_, spp = newest_spp_, width = finished.width, height = finished.height] {
        return preview_image(*image, spp, {}, width, height);
    });
}

void LiveDisplay::show(std::span<const PixelEstimate> film, int width, int height, double now) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (!client_ || now < next_ || film.size() != count || !client_->idle()) return;
    const Timer timer;
    auto pass = std::make_shared<const PassPixels>(pass_pixels(film));
    client_->show([image = newest_, spp = newest_spp_, pass, width, height] {
        return preview_image(*image, spp, *pass, width, height);
    });
    const double processors = std::max(1u, std::thread::hardware_concurrency());
    next_ = now + std::max(kLeastSeconds, kInterval * (timer.seconds() + client_->core_seconds() / processors));
}

std::vector<std::string> LiveDisplay::take_news() {
    return client_ ? client_->take_news() : std::vector<std::string>();
}

}  // namespace treefarm
