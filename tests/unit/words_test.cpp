// SPDX-License-Identifier: Apache-2.0
// Pages that people read in a terminal, an editor or a diff.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/markdown.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

constexpr std::ptrdiff_t kWidest = 140;

/// Characters of a line of UTF-8.
std::ptrdiff_t width(const std::string& text) {
    return std::count_if(text.begin(), text.end(),
                         [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
}

bool is_table(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first != std::string::npos && text[first] == '|';
}

TEST(Words, LinesOfPagesFitAnEditor) {
    const fs::path root = TREEFARM_SOURCE_DIR;
    const auto pages = test::markdown_pages();
    ASSERT_GT(pages.size(), 20u) << "no pages below " << root;
    for (const fs::path& page : pages) {
        const fs::path name = fs::relative(page, root);
        if (name.string().starts_with("docs/generated/")) continue;
        for (const test::MarkdownLine& line : test::markdown_lines(page))
            if (!is_table(line.text)) {
                EXPECT_LE(width(line.text), kWidest) << name.string() << ":" << line.number << ": break the line";
            }
    }
}

TEST(Words, AnUmlautIsOneCharacter) {
    EXPECT_EQ(width("Çavuş über m²"), 13);
    EXPECT_TRUE(is_table("  | a | b |"));
    EXPECT_FALSE(is_table("a | b"));
    EXPECT_FALSE(is_table(""));
}

}  // namespace
}  // namespace treefarm
