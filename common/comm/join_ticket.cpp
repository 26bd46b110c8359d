// SPDX-License-Identifier: Apache-2.0
#include "common/comm/join_ticket.h"

#include <sodium.h>

#include <charconv>
#include <sstream>

#include "common/base/error.h"
#include "common/comm/private_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFirstLine = "treefarm join 1";
constexpr std::size_t kMostTicketBytes = 4096;
constexpr const char* kCure = "name the run directory, or a copy of its file join, of a render with farm.join = true";
constexpr int kBase64 = sodium_base64_VARIANT_ORIGINAL;

template <std::size_t N>
std::array<std::uint8_t, N> draw_bytes() {
    if (sodium_init() < 0) throw RunError("libsodium finds no source of random numbers");
    std::array<std::uint8_t, N> bytes;
    randombytes_buf(bytes.data(), bytes.size());
    return bytes;
}

template <std::size_t N>
std::string base64(const std::array<std::uint8_t, N>& bytes) {
    char text[sodium_base64_ENCODED_LEN(N, sodium_base64_VARIANT_ORIGINAL)];
    sodium_bin2base64(text, sizeof text, bytes.data(), bytes.size(), kBase64);
    return text;
}

template <std::size_t N>
bool from_base64(const std::string& text, std::array<std::uint8_t, N>& bytes) {
    std::size_t length = 0;
    return sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &length, nullptr,
                             kBase64) == 0 &&
           length == N;
}

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
    throw InputError(Location{file, 0, 0}, what, kCure);
}

}  // namespace

JoinKey draw_join_key() {
    return draw_bytes<sizeof(JoinKey)>();
}

JoinRun draw_join_run() {
    return draw_bytes<sizeof(JoinRun)>();
}

std::string ticket_text(const JoinTicket& ticket) {
    return std::string(kFirstLine) + "\nrun " + base64(ticket.run) + "\naddress " + ticket.address + "\nport " +
           std::to_string(ticket.port) + "\nsecret " + base64(ticket.secret) + "\n";
}

JoinTicket parse_ticket(const std::string& text, const std::string& file) {
    std::istringstream lines(text);
    const auto value = [&](const std::string& name) {
        std::string line;
        if (!std::getline(lines, line) || !line.starts_with(name + " "))
            refuse(file, "is no ticket: \"" + name + "\" is missing");
        return line.substr(name.size() + 1);
    };
    std::string first;
    if (!std::getline(lines, first) || first != kFirstLine)
        refuse(file, "is no ticket: it does not begin with \"" + std::string(kFirstLine) + "\"");
    JoinTicket ticket;
    if (!from_base64(value("run"), ticket.run)) refuse(file, "is no ticket: its run is none");
    ticket.address = value("address");
    const std::string port = value("port");
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), ticket.port);
    if (error != std::errc() || end != port.data() + port.size() || ticket.port == 0)
        refuse(file, "is no ticket: its port is none");
    if (!from_base64(value("secret"), ticket.secret)) refuse(file, "is no ticket: its secret is none");
    return ticket;
}

void write_ticket(const fs::path& path, const JoinTicket& ticket) {
    write_private_file(path, ticket_text(ticket));
}

JoinTicket read_ticket(const fs::path& path) {
    return parse_ticket(read_private_file(path, kMostTicketBytes, kCure), path.string());
}

}  // namespace treefarm
