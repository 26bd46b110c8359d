// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace treefarm {

/// Message about a first word that is no command; "" if it is one, or an option.
std::string unknown_command(const CLI::App& app, const std::string& word);

/// Error in these arguments, found before parsing; "" if none: "--option=" without a value would swallow the next
/// argument.
std::string malformed_argument(std::span<const std::string> arguments);

/// Message about arguments that the parser refused with this error.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error, std::span<const std::string> arguments);

/// Advice for an option that other renderers have, and this one lacks or has as a job key: "--frames" -> "start one
/// render for each frame ...". "" if there is none.
std::string option_advice(const std::string& option, const std::string& command);

}  // namespace treefarm
