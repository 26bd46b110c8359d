// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace treefarm {

/// A token of 128 random bits, in hexadecimal digits.
std::string make_token();

/// The token in a file: one line of 16 to 256 letters, digits, "-", "_", "." and "~". Throws InputError.
std::string read_token(const std::filesystem::path& file);

/// Whether two texts are equal, in a time that says only how long `given` is.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

/// Whether an address is of this machine alone: "localhost", 127.*, ::1.
bool is_loopback(const std::string& address);

/// Whether a browser's Host header names this machine by itself. Another name that leads here is a foreign page's
/// (DNS rebinding).
bool names_loopback(const std::string& host_header);

}  // namespace treefarm
