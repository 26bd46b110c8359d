// SPDX-License-Identifier: Apache-2.0
#include "tests/support/plain_http.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

#include "common/base/timer.h"

namespace treefarm::test {

Client::Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

Client::~Client() {
    ::close(socket_);
}

void Client::send(const std::string& bytes) {
    [[maybe_unused]] const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::string Client::receive(double seconds) {
    std::string all;
    const Timer timer;
    while (timer.seconds() < seconds) {
        pollfd ready{socket_, POLLIN, 0};
        if (::poll(&ready, 1, 50) <= 0) continue;
        char part[4096];
        const ssize_t got = ::recv(socket_, part, sizeof part, 0);
        if (got <= 0) break;
        all.append(part, static_cast<std::size_t>(got));
    }
    return all;
}

HttpAnswer parse_answer(const std::string& bytes) {
    HttpAnswer answer;
    const std::size_t end = bytes.find("\r\n\r\n");
    if (!bytes.starts_with("HTTP/1.1 ") || end == std::string::npos) return answer;
    for (std::size_t at = bytes.find("\r\n") + 2; at < end;) {
        const std::size_t stop = bytes.find("\r\n", at), colon = bytes.find(": ", at);
        if (colon >= stop) return answer;
        answer.headers[bytes.substr(at, colon - at)] = bytes.substr(colon + 2, stop - colon - 2);
        at = stop + 2;
    }
    answer.status = std::atoi(bytes.c_str() + 9);
    answer.body = bytes.substr(end + 4);
    return answer;
}

HttpAnswer ask(int port, const std::string& request, const std::string& headers) {
    Client client(port);
    client.send(request + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port) + "\r\n" + headers + "\r\n");
    return parse_answer(client.receive(20));
}

}  // namespace treefarm::test
