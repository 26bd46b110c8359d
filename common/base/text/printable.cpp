// SPDX-License-Identifier: Apache-2.0
#include "common/base/text/printable.h"

#include <cstddef>
#include <cstdint>

namespace treefarm {

namespace {

std::uint32_t byte_at(std::string_view text, std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

/// Length in bytes of the UTF-8 sequence at `at`, and its character; 0 if the bytes there are not UTF-8.
std::size_t decode(std::string_view text, std::size_t at, std::uint32_t& character) {
    const std::uint32_t first = byte_at(text, at);
    if (first < 0x80) {
        character = first;
        return 1;
    }
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
    if (length == 0 || first > 0xf4) return 0;
    character = first & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
        const std::uint32_t next = byte_at(text, at + k);
        if ((next & 0xc0) != 0x80) return 0;
        character = character << 6 | (next & 0x3f);
    }
    constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800,
                                       0x10000};  // overlong forms are refused: they can hide a character
    const bool surrogate = character >= 0xd800 && character < 0xe000;
    return character < least[length] || character > 0x10ffff || surrogate ? 0 : length;
}

bool is_control(std::uint32_t character) {
    const bool line_end = character == 0x2028 || character == 0x2029;
    const bool turns_direction =
        (character >= 0x202a && character <= 0x202e) || (character >= 0x2066 && character <= 0x2069);
    return character < 0x20 || (character >= 0x7f && character < 0xa0) || line_end || turns_direction;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        std::uint32_t character = 0;
        const std::size_t length = decode(text, at, character);
        if (length == 0 || is_control(character))
            result += '?';
        else
            result += text.substr(at, length);
        at += length == 0 ? 1 : length;
    }
    return result;
}

std::string printable_lines(std::string_view text) {
    std::string lines;
    while (true) {
        const std::size_t end = text.find('\n');
        lines += printable(text.substr(0, end));
        if (end == std::string_view::npos) return lines;
        lines += '\n';
        text.remove_prefix(end + 1);
    }
}

}  // namespace treefarm
