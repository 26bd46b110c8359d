// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "serve/confined_folder.h"

namespace treefarm {

using FileJson = nlohmann::ordered_json;

/// JSON object of a file; empty if it holds none.
FileJson read_object(const ConfinedFolder& root, const std::string& path);

/// Member of an object if it has the expected type; else null. Files may contain anything.
FileJson number_of(const FileJson& object, const char* key);
FileJson text_of(const FileJson& object, const char* key);
FileJson object_of(const FileJson& object, const char* key);
FileJson array_of(const FileJson& object, const char* key);

/// Text of a JSON value; invalid UTF-8 is replaced.
std::string json_text(const FileJson& json);

}  // namespace treefarm
