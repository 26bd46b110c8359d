// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace treefarm {

/// The text without white space at both ends.
std::string_view trim(std::string_view text);

/// A decimal number that fills the whole text (white space around it is allowed). Nothing for NaN, infinity,
/// hexadecimal or trailing characters. What is too small for a double is 0 or denormal, what is too large is nothing.
std::optional<double> parse_number(std::string_view text);

/// A decimal integer that fills the whole text and fits into 64 bits.
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// "true" or "false".
std::optional<bool> parse_boolean(std::string_view text);

/// Shortest text that reads back to the same value.
std::string number_text(double value);
std::string number_text(float value);

/// The candidate with the smallest edit distance to an unknown word, for a message; "" if none is near.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// "a, b or c".
std::string listed(std::span<const std::string_view> words);

/// The advice about an unknown word: the nearest candidate, and `otherwise` in any case.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates,
                         const std::string& otherwise);

/// Input text for a message: quoted, printable, and no longer than a line can hold.
std::string in_quotes(std::string_view text);

/// A word as a shell reads it back: a command that a message tells can be typed.
std::string shell_quoted(const std::string& word);
/// Words as a line for a shell.
std::string shell_line(std::span<const std::string> words);

/// A file's name for a message: as in_quotes(), but whole unless absurdly long, since a reader must be able to find it.
std::string path_in_quotes(std::string_view path);

/// The text with control characters, line ends among them, replaced by "?".
std::string one_line(std::string_view text);

}  // namespace treefarm
