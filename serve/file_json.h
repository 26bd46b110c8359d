// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/runs/run_json.h"
#include "serve/confined_folder.h"

namespace treefarm {

using FileJson = RunJson;

/// The object that a file of a run holds (parse_run_json()); an empty one where it holds none.
FileJson read_object(const ConfinedFolder& root, const std::string& path);

/// Text of a JSON value; invalid UTF-8 is replaced.
std::string json_text(const FileJson& json);

}  // namespace treefarm
