// SPDX-License-Identifier: Apache-2.0
#include "serve/file_json.h"

namespace treefarm {

namespace {

constexpr std::size_t kMostBytes = 16 << 20;

/// So deep a render writes nothing, and a parser that calls itself would need much stack to print it.
constexpr int kMostDepth = 32;

FileJson member(const FileJson& object, const char* key, bool (FileJson::*is_kind)() const noexcept) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found != object.end() && ((*found).*is_kind)() ? *found : FileJson();
}

}  // namespace

FileJson read_object(const ConfinedFolder& root, const std::string& path) {
    const auto text = root.read(path, kMostBytes);
    if (!text) return FileJson::object();
    const auto not_too_deep = [](int depth, FileJson::parse_event_t, FileJson&) { return depth <= kMostDepth; };
    FileJson json = FileJson::parse(*text, not_too_deep, false);
    return json.is_object() ? json : FileJson::object();
}

FileJson number_of(const FileJson& object, const char* key) {
    return member(object, key, &FileJson::is_number);
}

FileJson text_of(const FileJson& object, const char* key) {
    return member(object, key, &FileJson::is_string);
}

FileJson object_of(const FileJson& object, const char* key) {
    return member(object, key, &FileJson::is_object);
}

FileJson array_of(const FileJson& object, const char* key) {
    FileJson array = member(object, key, &FileJson::is_array);
    return array.is_array() ? array : FileJson::array();
}

std::string json_text(const FileJson& json) {
    return json.dump(-1, ' ', false, FileJson::error_handler_t::replace);
}

}  // namespace treefarm
