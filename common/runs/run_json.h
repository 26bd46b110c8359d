// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/runs/run_files.h"
#include "common/runs/run_keys.h"

namespace treefarm {

using RunJson = nlohmann::ordered_json;

/// JSON object of a run's file, with former names of figures replaced by the present ones. Empty if the text is no
/// object, or nests deeper than renders write.
RunJson parse_run_json(const std::string& text);
/// As parse_run_json(), from a file; empty if it is missing.
RunJson read_run_json(const std::filesystem::path& file);

/// As parse_run_json(), from a file that must be valid. Throws RunJson::exception.
RunJson read_whole_run_json(const std::filesystem::path& file);

/// Member of an object if it has the expected type; else null, or an empty list.
RunJson number_of(const RunJson& object, RunKey key);
RunJson text_of(const RunJson& object, RunKey key);
RunJson object_of(const RunJson& object, RunKey key);
RunJson array_of(const RunJson& object, RunKey key);

/// Text or number in an object; else "" or the given number.
std::string text_in(const RunJson& object, RunKey key);
double number_in(const RunJson& object, RunKey key, double otherwise = 0);

/// Whether a render had a target error and ended above it.
bool missed_target(const RunJson& summary);

}  // namespace treefarm
