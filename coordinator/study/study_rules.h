// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/config/setting.h"
#include "coordinator/study/study.h"

namespace treefarm {

/// Part of a study file that holds job keys.
enum class StudyPart : std::uint8_t { job, scene, method, reference };

/// Throws InputError if the key belongs to another part of the study: the compared quantity and the budget must be
/// equal for all cells.
void check_study_key(const Setting& setting, StudyPart part);

/// Throws InputError unless the name fits a scene or a method, which become names of folders.
void check_study_name(const std::string& name, const Location& where);

/// Throws InputError if a folder does not fit a study: it holds a render, or another study that may not be replaced.
void check_study_folder(const std::filesystem::path& folder, const Study& study, bool overwrite);

}  // namespace treefarm
