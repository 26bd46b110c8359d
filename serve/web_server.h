// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "serve/site.h"

namespace treefarm {

/// What clients may cost.
struct WebLimits {
    std::size_t threads = 16;        ///< requests that are answered at once
    std::size_t waiting = 64;        ///< connections that wait for one; more are sent away
    double request_seconds = 5.0;    ///< until a request has come in whole
    double response_seconds = 30.0;  ///< until a response has been taken whole
    std::size_t request_bytes = 32 << 10;
};

/// Answers HTTP requests, one for each connection. A client that is slow, says nothing or too much is let go when its
/// time is over.
class WebServer {
  public:
    using Respond = std::function<SiteResponse(const SiteRequest&)>;  ///< called by several threads

    explicit WebServer(Respond respond, const WebLimits& limits = {});
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    /// Takes a port (0: any that is free) of an address; returns it. Throws InputError where it cannot be had.
    int bind(const std::string& address, int port);
    /// Begins to answer, in threads of its own.
    void start();
    /// Ends in a moment, whatever clients do.
    void stop();

  private:
    class Server;
    std::unique_ptr<Server> server_;
};

}  // namespace treefarm
