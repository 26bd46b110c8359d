// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/input_file.h"

#include <fstream>

#include "common/base/text/parse_text.h"
#include "coordinator/input/images/lfs_pointer.h"

namespace treefarm {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{8} << 30;

}  // namespace

std::uintmax_t input_file_size(const std::filesystem::path& path, const Location& asked_from) {
    std::error_code error;
    const std::string file = path.string();
    if (!std::filesystem::exists(path, error))
        throw InputError(asked_from, "there is no file " + path_in_quotes(file), "check the path");
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(asked_from, path_in_quotes(file) + " is not a file", "check the path");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > kMaxFileBytes)
        throw InputError(asked_from, path_in_quotes(file) + " has more than 8 GiB", "split it");
    std::string begin(64, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (is_lfs_pointer(begin)) throw InputError(asked_from, path_in_quotes(file) + " " + kLfsPointer, kLfsCure);
    return size;
}

std::string read_input_file(const std::filesystem::path& path, const Location& asked_from) {
    const std::uintmax_t size = input_file_size(path, asked_from);
    std::string text(static_cast<std::size_t>(size), '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(text.data(), static_cast<std::streamsize>(size));
    if (!in || in.gcount() != static_cast<std::streamsize>(size))
        throw InputError(asked_from, path_in_quotes(path.string()) + " cannot be read", "check its permissions");
    return text;
}

}  // namespace treefarm
