// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm::test {

/// A terminal's screen, as far as our output needs one: text, \r, \n, ESC[K, colours, and lines that wrap. It has no
/// bottom: what scrolls away is still there.
class Screen {
  public:
    explicit Screen(int columns) : columns_(columns) {}

    void feed(const std::string& bytes);
    /// Sets the width; what is there stays as it is.
    void resize(int columns) { columns_ = columns; }
    const std::vector<std::string>& rows() const { return rows_; }
    /// Rows that hold this text.
    int rows_with(const std::string& text) const;
    /// All rows, for a message.
    std::string text() const;

  private:
    void put(char c);
    void escape(const std::string& sequence);
    std::string& row() { return rows_[row_]; }

    int columns_;
    std::vector<std::string> rows_ = {""};
    std::size_t row_ = 0, column_ = 0;
    std::string escape_;  ///< that is not complete yet
};

}  // namespace treefarm::test
