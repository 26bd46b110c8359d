// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "serve/confined_folder.h"

namespace treefarm {

using FileJson = nlohmann::ordered_json;

/// A file that holds a JSON object; an empty object if it does not.
FileJson read_object(const ConfinedFolder& root, const std::string& path);

/// A member of an object, of the kind that is expected; null else. What comes from files may be anything.
FileJson number_of(const FileJson& object, const char* key);
FileJson text_of(const FileJson& object, const char* key);
FileJson object_of(const FileJson& object, const char* key);
FileJson array_of(const FileJson& object, const char* key);

/// Text of a JSON value, bytes that are no UTF-8 replaced.
std::string json_text(const FileJson& json);

}  // namespace treefarm
