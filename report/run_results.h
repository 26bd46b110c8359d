// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "report/study_results.h"

namespace treefarm {

/// True for a run directory whose render has ended.
bool is_run_folder(const std::filesystem::path& folder);

/// Single renders as a study without references: a scene per scene file and size, a method per set of settings, named
/// by those in which the renders differ; the first is the baseline. Errors are what the renders estimated of
/// themselves. Throws InputError where a folder is no run directory, or its error is not known.
StudyResults read_run_results(std::span<const std::filesystem::path> folders);

}  // namespace treefarm
