// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace treefarm {

/// 256 bits that nobody can guess: a secret, a nonce, or the key of one direction of a session.
using JoinKey = std::array<std::uint8_t, 32>;

/// Name of one coordinator that takes guests in.
using JoinRun = std::array<std::uint8_t, 16>;

/// A worker's way into a render that did not start it, as the file `join` of its run directory says.
struct JoinTicket {
    JoinRun run{};        ///< random: who answers there may be the coordinator of another run
    std::string address;  ///< a name or a number, IPv4 or IPv6
    std::uint16_t port = 0;
    JoinKey secret{};  ///< whoever has it may join

    bool operator==(const JoinTicket&) const = default;
};

/// Random bytes of the system. Throws RunError where it has none.
JoinKey draw_join_key();
JoinRun draw_join_run();

/// Text of a ticket: lines "name value", the secret in base64.
std::string ticket_text(const JoinTicket& ticket);

/// The ticket that a text is; `file` is named where it is none. Throws InputError.
JoinTicket parse_ticket(const std::string& text, const std::string& file);

/// Writes the file whole or not at all, readable by its owner alone. Throws RunError.
void write_ticket(const std::filesystem::path& path, const JoinTicket& ticket);

/// Reads a ticket from a file that this user alone can read. Throws InputError.
JoinTicket read_ticket(const std::filesystem::path& path);

}  // namespace treefarm
