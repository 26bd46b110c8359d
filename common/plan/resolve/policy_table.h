// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/base/policy.h"
#include "common/config/setting.h"

namespace treefarm {

/// All tuned constants, those of the decisions first.
std::vector<policy::Constant> tuned_constants();

/// The section [policy] of resolved.toml.
std::string write_policy();

/// Prefix of the constants among settings: "policy.guiding.giving_up".
inline constexpr std::string_view kPolicyPrefix = "policy.";

/// Cure for a resolved.toml that this build cannot repeat.
inline constexpr char kResolvedCure[] =
    "render job.toml instead, which leaves it to the program, or use the build that wrote it";

/// Throws InputError if the settings of a resolved.toml lack a constant, have an unknown one, or give one another
/// value. `file`: location for missing constants.
void check_policy(std::span<const Setting> settings, const Location& file);

/// Markdown table of all constants, for docs/.
std::string policy_documentation();

}  // namespace treefarm
