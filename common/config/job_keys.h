// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/config/setting.h"

namespace treefarm {

/// Form of a key's value in TOML.
enum class ValueKind {
    integer,
    number,
    number_or_text,
    boolean,
    text,
    text_list,   ///< a list of texts, or one with commas between
    off_switch,  ///< false, or a text that says when it is on
};

/// A value that is planned but not there yet, and what to use in its place.
struct UnavailableValue {
    std::string value;
    std::string cure;
};

/// One key of a job. Reading TOML, --set, writing job.toml and the documentation all go by this table.
struct JobKey {
    std::string name;  ///< "integrator.max_depth"
    ValueKind kind;
    std::string range;  ///< the values allowed, for messages and docs: "-1, or 1 and more"
    std::string doc;    ///< one line, with the unit
    std::function<bool(Job&, const std::string& text)> parse;  ///< false: not in `range`; the job is unchanged
    std::function<std::string(const Job&)> print;  ///< the value as parse() takes it; empty: a key that stores nothing
    std::vector<UnavailableValue> unavailable;
    std::function<std::string(const std::string&)> refusal = {};  ///< why parse() refuses a text; empty: by the range

    bool stored() const { return static_cast<bool>(print); }
};

/// All keys, sections together, in the order in which job.toml is written.
std::span<const JobKey> job_keys();

/// The key of this name, or nullptr.
const JobKey* find_job_key(const std::string& name);

/// Values for $name in the scene stand below this: "scene.defines.name".
inline constexpr char kDefinesPrefix[] = "scene.defines.";

/// A Markdown table of all keys with defaults, for docs/.
std::string job_key_documentation();

}  // namespace treefarm
