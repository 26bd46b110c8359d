// SPDX-License-Identifier: Apache-2.0
#include "common/base/terminal.h"

#include <sys/ioctl.h>

namespace treefarm {

namespace {

constexpr int kUsualColumns = 80;

struct Character {
    char32_t code = 0;
    std::size_t bytes = 1;
};

/// The UTF-8 character at byte `at`; an invalid byte counts as one character.
Character character_at(const std::string& text, std::size_t at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t bytes = first < 0xc0 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (bytes == 1 || at + bytes > text.size()) return {first, 1};
    char32_t code = first & (0x7fu >> bytes);
    for (std::size_t k = 1; k < bytes; ++k) {
        const auto next = static_cast<unsigned char>(text[at + k]);
        if ((next & 0xc0) != 0x80) return {first, 1};
        code = code << 6 | (next & 0x3f);
    }
    return {code, bytes};
}

/// Columns of a character by Unicode block, rather too wide than too narrow. The C library's answer would depend on the
/// locale.
int columns_of(char32_t code) {
    const bool combining = (code >= 0x300 && code < 0x370) || (code >= 0x200b && code <= 0x200f);
    const bool wide = (code >= 0x1100 && code < 0x1200) || (code >= 0x2e80 && code < 0xe000) ||
                      (code >= 0xf900 && code < 0xfb00) || (code >= 0xfe30 && code < 0xfe70) ||
                      (code >= 0xff00 && code < 0xff61) || code >= 0x1f000;
    return combining ? 0 : wide ? 2 : 1;
}

}  // namespace

int terminal_columns(int descriptor) {
    winsize size{};
    return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

int text_columns(const std::string& text) {
    int columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const Character c = character_at(text, at);
        columns += columns_of(c.code);
        at += c.bytes;
    }
    return columns;
}

std::string cut_to_columns(const std::string& text, int columns) {
    for (std::size_t at = 0; at < text.size();) {
        const Character c = character_at(text, at);
        columns -= columns_of(c.code);
        if (columns < 0) return text.substr(0, at);
        at += c.bytes;
    }
    return text;
}

}  // namespace treefarm
