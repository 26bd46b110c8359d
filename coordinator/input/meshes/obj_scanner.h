// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "common/base/error.h"

namespace treefarm {

/// Tokenizer of OBJ and MTL files, statement by statement. A backslash at the end of a line continues the statement.
class ObjScanner {
  public:
    ObjScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// Moves to the next statement and returns its keyword; false at the end of the file.
    bool next_statement(std::string_view& keyword) {
        while (true) {
            std::string_view rest;
            while (in_statement_ && next_word(rest)) {
            }
            while (at_ < text_.size() && text_[at_] == '\n')
                new_line();
            if (at_ >= text_.size()) return false;
            in_statement_ = true;
            if (next_word(keyword)) return true;
        }
    }

    /// The next word of the statement; false at its end.
    bool next_word(std::string_view& word) {
        skip_blanks();
        if (at_ >= text_.size() || text_[at_] == '\n') return false;
        if (text_[at_] == '#') {
            at_ = std::min(text_.find('\n', at_), text_.size());
            return false;
        }
        word_at_ = at_;
        while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n' && text_[at_] != '#' &&
               !at_continuation())
            ++at_;
        word = text_.substr(word_at_, at_ - word_at_);
        return true;
    }

    /// Location of the last word.
    Location where() const { return {file_, line_, static_cast<int>(word_at_ - line_start_) + 1}; }

    /// The rest of the statement without blanks around it: a name, which may contain blanks and '#'.
    std::string rest() {
        skip_blanks();
        word_at_ = at_;
        std::string text;
        const auto strip = [&] {
            while (!text.empty() && is_blank(text.back()))
                text.pop_back();
        };
        while (at_ < text_.size() && text_[at_] != '\n') {
            if (at_continuation()) {
                strip();
                skip_blanks();
                text += ' ';
            } else {
                text += text_[at_++];
            }
        }
        strip();
        return text;
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

    bool at_continuation() const {
        if (text_[at_] != '\\') return false;
        std::size_t end = at_ + 1;
        while (end < text_.size() && is_blank(text_[end]))
            ++end;
        return end >= text_.size() || text_[end] == '\n';
    }

    void skip_blanks() {
        while (at_ < text_.size()) {
            if (is_blank(text_[at_])) {
                ++at_;
            } else if (at_continuation()) {
                at_ = std::min(text_.find('\n', at_), text_.size());
                if (at_ < text_.size()) new_line();
            } else {
                return;
            }
        }
    }

    void new_line() {
        ++at_;
        ++line_;
        line_start_ = at_;
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0, word_at_ = 0, line_start_ = 0;
    int line_ = 1;
    bool in_statement_ = false;
};

}  // namespace treefarm
