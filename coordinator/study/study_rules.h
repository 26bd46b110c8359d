// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/setting.h"

namespace treefarm {

/// A part of a study file that holds job keys.
enum class StudyPart : std::uint8_t { job, scene, method, reference };

/// Throws InputError where a key has another place in a study: what is compared, and at what budget, must be the same
/// for all cells.
void check_study_key(const Setting& setting, StudyPart part);

/// Throws InputError unless this can name a scene or a method: names become names of folders.
void check_study_name(const std::string& name, const Location& where);

}  // namespace treefarm
