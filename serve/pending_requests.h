// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/base/timer.h"

namespace treefarm {

struct WebLimits;

/// Connections whose request has not arrived yet, and a pool of threads that answer those whose has: a silent client
/// occupies no thread. If there are too many, the oldest from the address with most is closed.
class PendingRequests {
  public:
    using Answer = std::function<void(int socket)>;  ///< answers and closes the connection; called by several threads

    /// `limits` must outlive the object.
    PendingRequests(const WebLimits& limits, Answer answer);
    ~PendingRequests();
    PendingRequests(const PendingRequests&) = delete;
    PendingRequests& operator=(const PendingRequests&) = delete;

    /// Takes over an accepted connection.
    void add(int socket);
    /// Whether a complete request waits for a thread.
    bool waits();

  private:
    struct Connection {
        int socket;
        std::string address;
        Timer age{};
        bool ready = false;  ///< its request has arrived
    };

    void watch();
    void work();
    void look(Connection& connection);
    void push_out();

    const WebLimits& limits_;
    const Answer answer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Connection> connections_;  ///< oldest first; socket -1: closed
    bool ending_ = false;
    std::vector<char> buffer_;
    std::vector<std::thread> threads_;
};

}  // namespace treefarm
