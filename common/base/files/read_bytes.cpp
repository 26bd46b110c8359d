// SPDX-License-Identifier: Apache-2.0
#include "common/base/files/read_bytes.h"

#include <cerrno>

#include "common/base/error.h"
#include "common/base/regular_file.h"

namespace treefarm {

namespace {

/// Reads up to `size` bytes; returns their number, which is less at the end of the file or after an error.
std::size_t read_up_to(int file, void* to, std::size_t size) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t got = ::read(file, static_cast<char*>(to) + done, size - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

}  // namespace

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path, const std::string& cure, std::uintmax_t most) {
    const auto refuse = [&](const std::string& what, const std::string& advice) {
        throw InputError(Location{path.string()}, what, advice);
    };
    std::error_code none;
    const auto status = std::filesystem::status(path, none);
    if (!std::filesystem::exists(status)) refuse("no such file", "check the path");
    if (!std::filesystem::is_regular_file(status)) refuse("not a regular file", cure);
    const std::uintmax_t size = std::filesystem::file_size(path, none);
    if (none || size > most) refuse("is larger than 2 GiB", "reduce its size");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    const Descriptor file = open_regular(path, O_RDONLY);
    if (!file || read_up_to(file.fd(), bytes.data(), bytes.size()) != bytes.size())
        refuse("cannot be read", "check its permissions");
    return bytes;
}

std::string read_text(const std::filesystem::path& path) {
    constexpr std::size_t kPart = 1 << 16;
    std::string text;
    const Descriptor file = open_regular(path, O_RDONLY);
    for (std::size_t got = kPart; file && got == kPart;) {
        const std::size_t before = text.size();
        text.resize(before + kPart);
        got = read_up_to(file.fd(), text.data() + before, kPart);
        text.resize(before + got);
    }
    return text;
}

}  // namespace treefarm
