// SPDX-License-Identifier: Apache-2.0
#include "coordinator/display/display_server.h"

#include <charconv>

#include "common/base/error.h"
#include "common/base/printable.h"

namespace treefarm {

namespace {

bool is_port(const std::string& text) {
    unsigned port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    return error == std::errc() && end == text.data() + text.size() && port > 0 && port < 65536;
}

}  // namespace

std::string DisplayServer::text() const {
    return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + port;
}

DisplayServer parse_display_server(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    DisplayServer server;
    if (colon != std::string::npos) server = {text.substr(0, colon), text.substr(colon + 1)};
    if (server.host.starts_with('[') && server.host.ends_with(']'))
        server.host = server.host.substr(1, server.host.size() - 2);
    else if (server.host.find(':') != std::string::npos)
        server.host.clear();  // it cannot be told where the address ends
    if (server.host.empty() || !is_port(server.port))
        throw InputError(Location{"--display-server " + printable(text), 0, 0}, "is no HOST:PORT",
                         "name where the viewer listens: tev by itself at 127.0.0.1:14158");
    return server;
}

}  // namespace treefarm
