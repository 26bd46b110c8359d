// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Throws InputError where the input of render, plan or debug is neither a Mitsuba scene nor a job, and says what to do
/// with it: a run directory has a job.toml, a study's folder a report.
void require_scene_or_job(const std::string& input);

/// Throws InputError where the input of study is no study file by its name.
void require_study_file(const std::string& input);

}  // namespace treefarm
