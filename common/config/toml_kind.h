// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>

namespace treefarm {

/// Purpose of a TOML file.
enum class TomlKind : std::uint8_t { job, study };

/// Throws InputError if a file is of another kind than the command takes, and names the right command.
void require_kind(const toml::table& table, const std::string& file, TomlKind wanted);

}  // namespace treefarm
