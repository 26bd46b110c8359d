// SPDX-License-Identifier: Apache-2.0
#include "serve/file_json.h"

namespace treefarm {

namespace {

constexpr std::size_t kMostBytes = 16 << 20;

}  // namespace

FileJson read_object(const ConfinedFolder& root, const std::string& path) {
    const auto text = root.read(path, kMostBytes);
    return text ? parse_run_json(*text) : FileJson::object();
}

std::string json_text(const FileJson& json) {
    return json.dump(-1, ' ', false, FileJson::error_handler_t::replace);
}

}  // namespace treefarm
