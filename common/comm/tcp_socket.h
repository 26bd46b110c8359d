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

/// A socket that listens, and its port.
struct Listener {
    Socket socket;
    std::uint16_t port = 0;
};

/// Listens at an address of this machine; port 0: the kernel chooses one. Throws InputError that names the job's key.
Listener listen_at(const std::string& address, std::uint16_t port);

/// A connection that waits, set up as all are, and where it comes from. Nothing: none waits.
std::optional<std::pair<Socket, std::string>> accept_from(const Socket& listener);

/// Connects within so many seconds, the look-up of the name not counted. `stopped`, if there is one, is asked now and
/// then; true ends the wait. Throws RunError that says why not.
Socket connect_to(const std::string& address, std::uint16_t port, double seconds,
                  const std::function<bool()>& stopped = {});

/// Prepares a socket of any kind: it never blocks; over TCP small messages go out at once, and a peer that acknowledges
/// nothing for 8 s is given up.
void set_up(const Socket& socket);

}  // namespace treefarm
