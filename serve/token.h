// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace treefarm {

/// A token of 128 random bits, in hexadecimal digits.
std::string make_token();

/// Token of a file: one line of 16 to 256 letters, digits, "-", "_", "." and "~". Throws InputError.
std::string read_token(const std::filesystem::path& file);

/// Whether two texts are equal; the time depends only on the length of `given`.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

/// Whether an address is a loopback one: "localhost", 127.*, ::1.
bool is_loopback(const std::string& address);

/// Whether a browser's Host header is a loopback name. Another name that resolves to this machine is a foreign page's
/// (DNS rebinding).
bool names_loopback(const std::string& host_header);

}  // namespace treefarm
