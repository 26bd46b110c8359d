// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/display_client.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "common/base/timer.h"
#include "coordinator/display/tcp_sender.h"
#include "coordinator/display/tev_packets.h"

namespace treefarm {

struct DisplayClient::Shared {
    DisplayServer server;
    std::string name;
    DisplayLimits limits;

    mutable std::mutex mutex;
    std::condition_variable changed;
    Make next;            ///< the waiting image; empty: none
    bool busy = false;    ///< an image is being sent
    bool ending = false;  ///< no further images
    bool gone = false;    ///< the thread has ended
    double core_seconds = 0;
    std::vector<std::string> news;

    std::atomic<bool> stopping = false;  ///< at once

    // Members of the client's thread only.
    std::optional<TcpSender> connection;
    int width = 0, height = 0;  ///< size of the server's image
    bool reported = false;

    void send(const RgbImage& image) {
        if (!connection) {
            connection.emplace(server.host, server.port, limits.connect, stopping);
            width = height = 0;
        }
        if (image.width != width || image.height != height)
            connection->send(tev_create_image(name, image.width, image.height), limits.stall);
        width = image.width;
        height = image.height;
        const int rows = tev_rows_per_packet(width);
        for (int first = 0; first < height; first += rows)
            connection->send(tev_update_rows(name, image, first, std::min(height, first + rows)), limits.stall);
    }
};

DisplayClient::DisplayClient(const DisplayServer& server, const std::string& name, const DisplayLimits& limits)
    : shared_(std::make_shared<Shared>()), last_seconds_(limits.last) {
    shared_->server = server;
    shared_->name = name;
    shared_->limits = limits;
    std::thread([shared = shared_] { work(shared); }).detach();
}

DisplayClient::~DisplayClient() {
    std::unique_lock lock(shared_->mutex);
    shared_->ending = true;
    shared_->changed.notify_all();
    const auto is_gone = [&] { return shared_->gone; };
    if (shared_->changed.wait_for(lock, std::chrono::duration<double>(last_seconds_), is_gone)) return;
    shared_->stopping = true;
    shared_->next = {};
    shared_->changed.wait_for(lock, std::chrono::milliseconds(500), is_gone);
}

void DisplayClient::show(Make make) {
    const std::lock_guard lock(shared_->mutex);
    shared_->next = std::move(make);
    shared_->changed.notify_all();
}

bool DisplayClient::idle() const {
    const std::lock_guard lock(shared_->mutex);
    return !shared_->busy && !shared_->next;
}

double DisplayClient::core_seconds() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->core_seconds;
}

std::vector<std::string> DisplayClient::take_news() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->news, {});
}

void DisplayClient::work(const std::shared_ptr<Shared>& shared) {
    Shared& s = *shared;
    std::unique_lock lock(s.mutex);
    while (true) {
        s.changed.wait(lock, [&] { return s.next || s.ending || s.stopping; });
        if (!s.next || s.stopping) break;
        const Make make = std::exchange(s.next, {});
        s.busy = true;
        lock.unlock();
        const double before = thread_cpu_seconds();
        std::string trouble;
        try {
            s.send(make());
        } catch (const std::exception& error) {
            trouble = error.what();
            s.connection.reset();
        }
        const double seconds = thread_cpu_seconds() - before;
        lock.lock();
        s.core_seconds = seconds;
        if (!trouble.empty() && !s.stopping) {
            if (!std::exchange(s.reported, true))
                s.news.push_back("the display server " + s.server.text() + " shows nothing: " + trouble +
                                 "; the render goes on, and it is tried again now and then");
            s.changed.wait_for(lock, std::chrono::duration<double>(s.limits.retry),
                               [&] { return s.ending || s.stopping; });
        }
        s.busy = false;
        if (!trouble.empty() && s.ending) break;
    }
    s.connection.reset();
    s.gone = true;
    s.changed.notify_all();
}

}  // namespace treefarm
