// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/base/descriptor.h"

namespace treefarm {

using Socket = Descriptor;

/// A listening socket and its port.
struct Listener {
    Socket socket;
    std::uint16_t port = 0;
};

/// Listens at an address of this machine; port 0: chosen by the kernel. Throws InputError with the job's key.
Listener listen_at(const std::string& address, std::uint16_t port);

/// A waiting connection, set up, and its origin; empty if there is none.
std::optional<std::pair<Socket, std::string>> accept_from(const Socket& listener);

/// Connects within `seconds`, not counting the look-up of the name. `stopped`, if given, is polled; true ends the wait.
/// Throws RunError with the reason.
Socket connect_to(const std::string& address, std::uint16_t port, double seconds,
                  const std::function<bool()>& stopped = {});

/// Sets the options of a socket: non-blocking; over TCP, small messages are sent at once, and a peer that acknowledges
/// nothing for 8 s is given up.
void set_up(const Socket& socket);

}  // namespace treefarm
