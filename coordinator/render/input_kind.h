// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Throws InputError, with advice, if the input of render, plan or debug is neither a Mitsuba scene nor a job: a run
/// directory has a job.toml, a study's folder a report.
void require_scene_or_job(const std::string& input);

/// Throws InputError if the input of study is no study file by its name.
void require_study_file(const std::string& input);

}  // namespace treefarm
