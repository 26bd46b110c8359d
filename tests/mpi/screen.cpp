// SPDX-License-Identifier: Apache-2.0
#include "tests/mpi/screen.h"

#include <algorithm>
#include <cctype>

namespace treefarm::test {

void Screen::feed(const std::string& bytes) {
    for (const char c : bytes) {
        if (!escape_.empty() || c == '\x1b') {
            escape_ += c;
            if (escape_.size() > 2 && std::isalpha(static_cast<unsigned char>(c))) {
                escape(escape_);
                escape_.clear();
            }
        } else if (c == '\r') {
            column_ = 0;
        } else if (c == '\n') {
            if (++row_ == rows_.size()) rows_.emplace_back();
        } else {
            put(c);
        }
    }
}

void Screen::escape(const std::string& sequence) {
    if (sequence == "\x1b[K") row().resize(std::min(row().size(), column_));
    if (sequence.back() != 'K' && sequence.back() != 'm') row() += "<unknown escape sequence>";
}

void Screen::put(char c) {
    if (column_ >= static_cast<std::size_t>(columns_)) {
        column_ = 0;
        if (++row_ == rows_.size()) rows_.emplace_back();
    }
    if (row().size() <= column_) row().resize(column_ + 1, ' ');
    row()[column_++] = c;
}

int Screen::rows_with(const std::string& text) const {
    return static_cast<int>(
        std::count_if(rows_.begin(), rows_.end(), [&](const std::string& r) { return r.find(text) != r.npos; }));
}

std::string Screen::text() const {
    std::string all;
    for (const std::string& r : rows_)
        all += r + "\n";
    return all;
}

}  // namespace treefarm::test
