// SPDX-License-Identifier: Apache-2.0
#include "common/base/files/read_bytes.h"

#include <fstream>
#include <iterator>

#include "common/base/error.h"

namespace treefarm {

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
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!file || file.gcount() != static_cast<std::streamsize>(size)) refuse("cannot be read", "check its permissions");
    return bytes;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace treefarm
