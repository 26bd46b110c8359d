// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/base/error.h"
#include "common/config/setting.h"

namespace treefarm {

/// Documentation of a constant of policy.h.
struct PolicyEntry {
    const char* name;  ///< "guiding.giving_up"
    double value;
    bool single;           ///< float, whose shortest text is shorter than that of a double
    const char* meaning;   ///< explanation with the unit
    const char* evidence;  ///< source: a publication, a page of bench/log, or a guess
};

/// The value as text, for resolved.toml and the docs.
std::string value_text(const PolicyEntry& entry);

/// Every constant of policy.h, in its order.
std::span<const PolicyEntry> policy_table();

/// The section [policy] of resolved.toml.
std::string write_policy();

/// Prefix of the constants among settings: "policy.guiding.giving_up".
inline constexpr char kPolicyPrefix[] = "policy.";

/// Cure for a resolved.toml that this build cannot repeat.
inline constexpr char kResolvedCure[] =
    "render job.toml instead, which leaves it to the program, or use the build that wrote it";

/// Throws InputError if the settings of a resolved.toml lack a constant, have an unknown one, or give one another
/// value. `file`: location for missing constants.
void check_policy(std::span<const Setting> settings, const Location& file);

/// Markdown table of all constants, for docs/.
std::string policy_documentation();

}  // namespace treefarm
