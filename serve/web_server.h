// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "serve/site.h"

namespace treefarm {

/// Limits of the clients' cost.
struct WebLimits {
    std::size_t threads = 16;        ///< requests answered at the same time
    std::size_t waiting = 64;        ///< connections without a thread; one more closes the oldest
    double request_seconds = 5.0;    ///< until a request has arrived completely
    double response_seconds = 30.0;  ///< until a response has been read completely; request_seconds if others wait
    std::size_t request_bytes = 32 << 10;
};

/// HTTP server with one request per connection. A client that is slow, silent or sends too much is disconnected at its
/// time limit.
class WebServer {
  public:
    using Respond = std::function<SiteResponse(const SiteRequest&)>;  ///< called by several threads

    explicit WebServer(Respond respond, const WebLimits& limits = {});
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    /// Binds a port (0: any free one) of an address; returns it. Throws InputError if that fails.
    int bind(const std::string& address, int port);
    /// Starts answering, in threads of its own.
    void start();
    /// Stops promptly, whatever clients do.
    void stop();

  private:
    class Server;
    std::unique_ptr<Server> server_;
};

}  // namespace treefarm
