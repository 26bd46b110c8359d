// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/display_server.h"

#include <charconv>

#include "common/base/error.h"
#include "common/base/text/printable.h"

namespace treefarm {

namespace {

/// Nothing but a port, or 0.
std::uint16_t port_of(const std::string& text) {
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    return error == std::errc() && end == text.data() + text.size() ? port : std::uint16_t{0};
}

}  // namespace

std::string DisplayServer::text() const {
    return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + std::to_string(port);
}

DisplayServer parse_display_server(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    DisplayServer server;
    if (colon != std::string::npos) server = {text.substr(0, colon), port_of(text.substr(colon + 1))};
    if (server.host.starts_with('[') && server.host.ends_with(']'))
        server.host = server.host.substr(1, server.host.size() - 2);
    else if (server.host.find(':') != std::string::npos)
        server.host.clear();  // it cannot be told where the address ends
    if (server.host.empty() || server.port == 0)
        throw InputError(Location{"--display-server " + printable(text), 0, 0}, "is no HOST:PORT",
                         "name where the viewer listens: tev by itself at 127.0.0.1:14158");
    return server;
}

}  // namespace treefarm
