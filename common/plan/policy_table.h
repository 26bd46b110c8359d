// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/config/setting.h"

namespace treefarm {

/// One constant of policy.h, explained.
struct PolicyEntry {
    const char* name;  ///< "guiding.giving_up"
    double value;
    bool single;           ///< a float: its shortest text is shorter than the double's
    const char* meaning;   ///< with the unit
    const char* evidence;  ///< where it comes from: a publication, a page of bench/log, or that it is a guess
};

/// The value, as resolved.toml and the docs have it.
std::string value_text(const PolicyEntry& entry);

/// Every constant of policy.h, in its order.
std::span<const PolicyEntry> policy_table();

/// The section [policy] of resolved.toml.
std::string write_policy();

/// The settings of a job file without those of [policy]. Where there are any, it is a resolved.toml: each constant has
/// to be there with this build's value, and each key of a job. Throws InputError, which names the first that is not.
std::vector<Setting> without_policy(std::vector<Setting> settings);

/// A Markdown table of all constants, for docs/.
std::string policy_documentation();

}  // namespace treefarm
