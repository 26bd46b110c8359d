// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace treefarm {

/// The text without white space at either end.
std::string_view trim(std::string_view text);

/// Decimal number that fills the whole text (white space around it is allowed). Empty for NaN, infinity, hexadecimal,
/// trailing characters and overflow. Underflow gives 0 or a denormal.
std::optional<double> parse_number(std::string_view text);

/// Decimal integer that fills the whole text and fits into 64 bits.
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// Boolean from "true" or "false"; empty for other text.
std::optional<bool> parse_boolean(std::string_view text);

/// Shortest text that reads back to the same value.
std::string number_text(double value);
std::string number_text(float value);

/// Candidate with the smallest edit distance to an unknown word, for a message; "" if none is similar.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// The words as an enumeration: "a, b or c".
std::string listed(std::span<const std::string_view> words);

/// Advice about an unknown word: the nearest candidate, if any, and `otherwise`.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates,
                         const std::string& otherwise);

/// Input text for a message: quoted, printable, and shortened to a line.
std::string in_quotes(std::string_view text);

/// A word quoted for a shell, so that a command in a message can be typed.
std::string shell_quoted(const std::string& word);
/// Words as a command line for a shell.
std::string shell_line(std::span<const std::string> words);

/// A file's name for a message: as in_quotes(), but only absurdly long names are shortened.
std::string path_in_quotes(std::string_view path);

/// The text with control characters and line ends replaced by "?".
std::string one_line(std::string_view text);

}  // namespace treefarm
