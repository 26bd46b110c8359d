// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Address of a viewer with tev's protocol.
struct DisplayServer {
    std::string host;
    std::uint16_t port = 0;

    std::string text() const;
};

/// Address from "HOST:PORT" or "[IPv6]:PORT". Throws InputError, which names --display-server.
DisplayServer parse_display_server(const std::string& text);

}  // namespace treefarm
