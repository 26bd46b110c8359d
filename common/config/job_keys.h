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
    text_list,   ///< a list of texts, or one comma-separated text
    off_switch,  ///< false, or the word that stands for on
};

/// A value that is planned for a later version, and the advice given until then.
struct UnavailableValue {
    std::string value;
    std::string cure;
};

/// A job key. This table drives reading of TOML and --set, writing of job.toml, and the documentation.
struct JobKey {
    std::string name;  ///< "integrator.max_depth"
    ValueKind kind;
    std::string range;  ///< allowed values, for messages and docs: "-1, or 1 and more"
    std::string doc;    ///< documentation: one line, with the unit
    std::function<bool(Job&, const std::string& text)> parse;  ///< false: not in `range`; the job is unchanged
    std::function<std::string(const Job&)> print;  ///< the value as parse() takes it; empty: a key that stores nothing
    std::vector<UnavailableValue> unavailable;
    std::function<std::string(const std::string&)> refusal =
        {};  ///< reason why parse() refuses a text; empty: it is not in `range`

    bool stored() const { return static_cast<bool>(print); }
};

/// All keys, section by section, in the order of job.toml.
std::span<const JobKey> job_keys();

/// The key of this name, or nullptr.
const JobKey* find_job_key(const std::string& name);

/// Prefix of keys that give values for $name in the scene: "scene.defines.name".
inline constexpr char kDefinesPrefix[] = "scene.defines.";

/// Markdown table of all keys with their defaults, for docs/.
std::string job_key_documentation();

}  // namespace treefarm
