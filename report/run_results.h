// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "report/study_results.h"

namespace treefarm {

/// Whether a folder is a run directory whose render has ended.
bool is_run_folder(const std::filesystem::path& folder);

/// Single renders as a study without references: a scene per scene file and size, a method per set of settings, named
/// by the settings in which the renders differ; the first is the baseline. Errors are the renders' own estimates.
/// Throws InputError if a folder is no run directory, or its error is unknown.
StudyResults read_run_results(std::span<const std::filesystem::path> folders);

}  // namespace treefarm
