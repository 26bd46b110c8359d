// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "coordinator/study/study.h"

namespace treefarm {

/// Throws InputError where a study does not belong into a folder: it holds a render, or another study and that is not
/// to be replaced.
void check_study_folder(const std::filesystem::path& folder, const Study& study, bool overwrite);

}  // namespace treefarm
