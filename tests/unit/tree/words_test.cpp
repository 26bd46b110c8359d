// SPDX-License-Identifier: Apache-2.0
// Pages that people read in a terminal, an editor or a diff, and comments that they read one at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

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

constexpr std::array kFolders = {"common", "worker", "coordinator", "cli", "report", "serve", "bench", "tests"};

/// A `///` comment's first line, without its mark.
struct Comment {
    int line = 0;  ///< from 1 on
    std::string text;
};

/// Position of the mark "///" of a line: at its beginning, or as "///<" behind code; npos if the line has none.
std::size_t mark_of(const std::string& line) {
    const std::size_t first = line.find_first_not_of(' ');
    if (first != std::string::npos && line.compare(first, 3, "///") == 0) return first;
    const std::size_t behind = line.find("///<");
    const bool in_quotes =
        std::count(line.begin(), line.begin() + std::ptrdiff_t(std::min(behind, line.size())), '"') % 2;
    return in_quotes ? std::string::npos : behind;
}

/// First lines of the comments before declarations and behind members; a comment goes on as long as its mark does.
std::vector<Comment> comments(std::istream& source) {
    std::vector<Comment> found;
    std::string before;  // the mark of the line before
    std::string text;
    for (int line = 1; std::getline(source, text); ++line) {
        const std::size_t at = mark_of(text);
        const std::string mark = at == std::string::npos ? "" : text.compare(at, 4, "///<") == 0 ? "///<" : "///";
        const bool goes_on = mark == before && text.find_first_not_of(' ') == at;
        if (!mark.empty() && !goes_on) {
            const std::size_t words = std::min(text.find_first_not_of(' ', at + mark.size()), text.size());
            found.push_back({line, text.substr(words)});
        }
        before = mark;
    }
    return found;
}

/// Whether a comment can be read only with the line above it. `///< of the film`, `///< that are open` and `///< its
/// name` are none: the member is their subject.
bool hides_its_subject(std::string_view text) {
    for (const std::string_view word : {"The same", "the same", "Those", "those", "These", "these", "That", "Of", "Its",
                                        "One that", "one that", "As above", "as above", "All of them", "all of them"})
        if (text.starts_with(word) &&
            (text.size() == word.size() || !std::isalnum(static_cast<unsigned char>(text[word.size()]))))
            return true;
    return false;
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

TEST(Words, CommentsNameTheirSubject) {
    const fs::path root = TREEFARM_SOURCE_DIR;
    std::size_t files = 0;
    for (const char* folder : kFolders)
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const fs::path& file = entry.path();
            const std::string name = fs::relative(file, root).string();
            if (file.extension() != ".h" && file.extension() != ".cpp") continue;
            ++files;
            std::ifstream source(file);
            for (const Comment& comment : comments(source))
                EXPECT_FALSE(hides_its_subject(comment.text))
                    << name << ":" << comment.line << ": \"" << comment.text
                    << "\" can be read only with the line above it; begin with what is declared, as a noun phrase";
        }
    EXPECT_GT(files, 500u) << "no sources below " << root;
}

TEST(Words, OnlyTheFirstLineOfACommentIsItsBeginning) {
    std::istringstream source(
        "/// The width\n"
        "/// of a film.\n"
        "int width;  ///< of the film\n"
        "            ///< those of its margin included\n"
        "/// Of a film.\n"
        "int height;\n"
        "// The same.\n"
        "int area;  ///<   the same, squared\n"
        "const char* mark = \"/// The same\";\n");
    const std::vector<Comment> found = comments(source);
    ASSERT_EQ(found.size(), 4u);
    const std::vector<int> lines = {1, 3, 5, 8};
    const std::vector<bool> hidden = {false, false, true, true};
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].line, lines[i]);
        EXPECT_EQ(hides_its_subject(found[i].text), hidden[i]) << found[i].text;
    }
    for (const char* hidden_one : {"Those.", "That of a sphere.", "These and --quiet.", "Its words.",
                                   "As above, in pieces.", "One that waits.", "All of them."})
        EXPECT_TRUE(hides_its_subject(hidden_one)) << hidden_one;
    for (const char* clear :
         {"that are open", "its name", "All of the film.", "One pixel.", "As many as there are lights."})
        EXPECT_FALSE(hides_its_subject(clear)) << clear;
    EXPECT_FALSE(hides_its_subject("Offset of a ray."));
}

}  // namespace
}  // namespace treefarm
