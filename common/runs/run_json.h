// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/runs/run_files.h"
#include "common/runs/run_keys.h"

namespace treefarm {

using RunJson = nlohmann::ordered_json;

/// The object that a file of a run holds, with former names of figures replaced by the current ones. An object without
/// keys where the text is no object or nests deeper than any that a render writes.
RunJson parse_run_json(const std::string& text);
/// That of a file; an object without keys where there is none.
RunJson read_run_json(const std::filesystem::path& file);

/// That of a file which has to be whole. Throws RunJson::exception.
RunJson read_whole_run_json(const std::filesystem::path& file);

/// A member of an object, of the kind that is expected; else null, or a list without elements.
RunJson number_of(const RunJson& object, RunKey key);
RunJson text_of(const RunJson& object, RunKey key);
RunJson object_of(const RunJson& object, RunKey key);
RunJson array_of(const RunJson& object, RunKey key);

/// A text or a number of an object; else "" or the number given.
std::string text_in(const RunJson& object, RunKey key);
double number_in(const RunJson& object, RunKey key, double otherwise = 0);

/// Whether a render was to reach an error and has ended above it.
bool missed_target(const RunJson& summary);

}  // namespace treefarm
