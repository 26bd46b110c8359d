// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace treefarm {

/// Random 256 bits: a secret, a nonce, or the key of one direction of a session.
using JoinKey = std::array<std::uint8_t, 32>;

/// Random identity of a coordinator that accepts guests.
using JoinRun = std::array<std::uint8_t, 16>;

/// Data with which a worker joins a running render, from the file `join` of its run directory.
struct JoinTicket {
    JoinRun run{};        ///< random: the address may be reused by the coordinator of another run
    std::string address;  ///< a host name or a number, IPv4 or IPv6
    std::uint16_t port = 0;
    JoinKey secret{};  ///< authorises to join

    bool operator==(const JoinTicket&) const = default;
};

/// Random bytes of the operating system. Throws RunError if there are none.
JoinKey draw_join_key();
JoinRun draw_join_run();

/// Text of a ticket: lines "name value", the secret in base64.
std::string ticket_text(const JoinTicket& ticket);

/// Ticket from its text; `file`: for messages. Throws InputError if the text is malformed.
JoinTicket parse_ticket(const std::string& text, const std::string& file);

/// Writes the file atomically, readable by its owner alone. Throws RunError.
void write_ticket(const std::filesystem::path& path, const JoinTicket& ticket);

/// Reads a ticket from a file that only this user can read. Throws InputError.
JoinTicket read_ticket(const std::filesystem::path& path);

}  // namespace treefarm
