// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/resolve.h"

namespace treefarm {

/// The job without where it is written: that is no part of a job that somebody repeats; what is written is.
std::string job_without_output(Job job);

/// The file resolved.toml: a job as it was used, and the tuned constants.
std::string write_resolved(const Resolved& job);

/// Budget and farm of a resolved.toml, and its other settings.
Job read_resolved(const std::string& toml, const std::string& name);

/// Whether a render may go on with another value of this key: its bits do not depend on it, or it says how long.
bool may_change_on_resume(const std::string& key);

/// The first key that two jobs differ in and that may not change: "guiding.type was \"auto\", is \"none\""; "" if there
/// is none.
std::string first_difference(const Job& before, const Job& now);

}  // namespace treefarm
