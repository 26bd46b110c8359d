// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "coordinator/study/study.h"

namespace treefarm {

/// Throws InputError if a folder does not fit a study: it holds a render, or another study that may not be replaced.
void check_study_folder(const std::filesystem::path& folder, const Study& study, bool overwrite);

}  // namespace treefarm
