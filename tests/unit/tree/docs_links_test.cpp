// SPDX-License-Identifier: Apache-2.0
// Links of pages, and what comments say of them, lead somewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>

#include "tests/support/markdown.h"
#include "tests/support/source_root.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

using test::kRoot;

std::string name_of(const fs::path& file) {
    return fs::relative(file, kRoot).string();
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool has_anchor(const fs::path& page, const std::string& anchor) {
    const auto known = test::anchors(page);
    return std::find(known.begin(), known.end(), anchor) != known.end();
}

/// The fault of a link of a page; empty: none.
std::string fault(const fs::path& page, const test::MarkdownLink& link) {
    const fs::path target = link.path.empty() ? page : (page.parent_path() / link.path).lexically_normal();
    if (!fs::exists(target)) return "there is no " + name_of(target);
    if (link.anchor.empty()) return "";
    if (target.extension() != ".md") return "only pages have anchors";
    return has_anchor(target, link.anchor) ? "" : name_of(target) + " has no heading for #" + link.anchor;
}

TEST(DocsLinks, LeadToPagesAndHeadings) {
    std::size_t links = 0;
    for (const fs::path& page : test::markdown_pages())
        for (const test::MarkdownLink& link : test::local_links(page)) {
            ++links;
            EXPECT_EQ(fault(page, link), "") << name_of(page) << ":" << link.line;
        }
    EXPECT_GT(links, 100u);
}

TEST(DocsLinks, TheCheckSeesBadOnes) {
    const fs::path page = kRoot / "docs/glossary.md";
    EXPECT_EQ(fault(page, {1, "design/guiding.md", "the-tree"}), "");
    EXPECT_NE(fault(page, {1, "design/guiding.md", "the-bush"}), "");
    EXPECT_NE(fault(page, {1, "design/gliding.md", ""}), "");
}

/// Whether a page has a section, a term in bold or one that begins an item of a list, that says so.
bool has_section(const fs::path& page, const std::string& title) {
    static const std::regex term(R"((?:^|\s)\*\*([^*]+)\*\*|^- `([^`]+)`)");
    const auto plain = [](std::string text) {
        std::erase(text, '`');
        return lower(std::move(text));
    };
    const auto says = [&](const std::string& text) { return plain(text).find(plain(title)) != std::string::npos; };
    const auto titles = test::headings(page);
    if (std::any_of(titles.begin(), titles.end(), says)) return true;
    for (const test::MarkdownLine& line : test::markdown_lines(page))
        for (std::sregex_iterator it(line.text.begin(), line.text.end(), term), end; it != end; ++it)
            if (says((*it)[1]) || says((*it)[2])) return true;
    return false;
}

/// Comments as running text: "///" and "#" at the beginning of a line are spaces.
std::string running_text(const fs::path& file) {
    static const std::regex mark(R"(\n[ \t]*(?:///?<?|#)?[ \t]*)");
    return std::regex_replace(test::read_file(file), mark, " ");
}

/// Faults of a text's citations of pages, as in: docs/design/error.md, "error", or docs/design/error.md#error.
std::vector<std::string> faults_of_citations(const std::string& text) {
    static const std::regex citation(R"re(([\w./-]*\w\.md)\b(?:#([\w-]+))?(?:, "([^"]+)")?)re");
    std::vector<std::string> faults;
    for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it) {
        const std::string page = (*it)[1], anchor = (*it)[2], title = (*it)[3];
        const bool has_folder = page.starts_with("docs/") || page.starts_with("bench/log/");
        if (!has_folder && !title.empty()) faults.push_back(page + " is cited without its folder");
        if (!has_folder) continue;
        if (!fs::exists(kRoot / page))
            faults.push_back("there is no " + page);
        else if (!anchor.empty() && !has_anchor(kRoot / page, anchor))
            faults.push_back(page + " has no heading for #" + anchor);
        else if (!title.empty() && !has_section(kRoot / page, title))
            faults.push_back(page + " has no section \"" + title + "\"");
    }
    return faults;
}

bool is_source(const fs::path& file) {
    static const std::set<std::string> kinds = {".h", ".cpp", ".in", ".py", ".cmake", ".txt", ".toml", ".xml", ""};
    return kinds.contains(file.extension().string()) && file.filename() != "docs_links_test.cpp";
}

TEST(DocsLinks, CommentsCiteSectionsThatExist) {
    std::size_t files = 0;
    for (const char* folder :
         {"common", "coordinator", "worker", "report", "serve", "cli", "tests", "bench", "cmake", "deploy", "configs"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            if (!entry.is_regular_file() || !is_source(entry.path())) continue;
            ++files;
            for (const std::string& message : faults_of_citations(running_text(entry.path())))
                ADD_FAILURE() << name_of(entry.path()) << ": " << message;
        }
    EXPECT_GT(files, 300u);
}

TEST(DocsLinks, TheCheckSeesBadCitations) {
    EXPECT_TRUE(faults_of_citations("see docs/design/guiding.md, \"the tree\", and docs/glossary.md.").empty());
    EXPECT_EQ(faults_of_citations("docs/design/guiding.md, \"the bush\"").size(), 1u);
    EXPECT_TRUE(faults_of_citations("docs/design/guiding.md#the-tree").empty());
    EXPECT_EQ(faults_of_citations("docs/design/guiding.md#the-bush").size(), 1u);
    EXPECT_EQ(faults_of_citations("docs/guiding.md").size(), 1u);
    EXPECT_EQ(faults_of_citations("(architecture.md, \"faults\")").size(), 1u);
}

/// Files of the source tree that a page names in code: `common/film/combine.h`.
std::vector<std::string> named_files(const fs::path& page) {
    static const std::regex name(
        "`((?:common|coordinator|worker|report|cli|tests|bench|cmake|deploy|configs|docs)/[^` ]+)`");
    std::vector<std::string> files;
    for (const test::MarkdownLine& line : test::markdown_lines(page))
        for (std::sregex_iterator it(line.text.begin(), line.text.end(), name), end; it != end; ++it)
            if ((*it)[1].str().find_first_of("*<{:") == std::string::npos) files.push_back((*it)[1]);
    return files;
}

/// Whether a page is a subject of the log, which is frozen.
bool is_of_the_log(const fs::path& page) {
    return page.parent_path() == kRoot / "bench/log" && page.filename() != "README.md";
}

TEST(DocsLinks, FilesThatPagesNameExist) {
    std::size_t names = 0;
    for (const fs::path& page : test::markdown_pages()) {
        if (is_of_the_log(page)) continue;  // frozen
        for (const std::string& file : named_files(page)) {
            ++names;
            const bool is_program = fs::exists(kRoot / (file + ".cpp"));  // bench/guide_bench
            EXPECT_TRUE(is_program || fs::exists(kRoot / file)) << name_of(page) << " names " << file;
        }
    }
    EXPECT_GT(names, 100u);
}

TEST(DocsLog, SectionsAreQuestionsWithTheirDay) {
    static const std::regex day(R"(\*.*\b20\d\d\b.*)");
    std::size_t sections = 0;
    for (const fs::path& page : test::markdown_pages()) {
        if (!is_of_the_log(page)) continue;
        std::string question;
        for (const test::MarkdownLine& line : test::markdown_lines(page)) {
            if (line.text.starts_with("## ")) {
                ++sections;
                question = line.text;
                EXPECT_TRUE(question.ends_with("?")) << name_of(page) << ":" << line.number;
            } else if (!question.empty() && !line.text.empty()) {
                EXPECT_TRUE(std::regex_match(line.text, day)) << name_of(page) << " has no day below " << question;
                question.clear();
            }
        }
    }
    EXPECT_GT(sections, 80u);
}

TEST(DocsLog, TablesAreLinked) {
    std::set<fs::path> linked;
    for (const fs::path& page : test::markdown_pages())
        for (const test::MarkdownLink& link : test::local_links(page))
            linked.insert((page.parent_path() / link.path).lexically_normal());
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "bench/log"))
        if (entry.path().extension() == ".csv") {
            EXPECT_TRUE(linked.contains(entry.path())) << "no page says what " << name_of(entry.path()) << " holds";
        }
}

/// Pages within so many clicks of another.
std::set<fs::path> pages_within(int clicks, const fs::path& page) {
    std::set<fs::path> pages = {page};
    for (; clicks > 0; --clicks) {
        std::set<fs::path> next = pages;
        for (const fs::path& known : pages)
            for (const test::MarkdownLink& link : test::local_links(known))
                if (link.path.ends_with(".md")) next.insert((known.parent_path() / link.path).lexically_normal());
        pages = std::move(next);
    }
    return pages;
}

TEST(DocsLinks, ReadmeLeadsToEveryPageOfTheDocumentation) {
    const auto pages = pages_within(1, kRoot / "README.md");
    for (const fs::path& page : test::markdown_pages())
        if (name_of(page).starts_with("docs/")) {
            EXPECT_TRUE(pages.contains(page)) << "README.md does not link " << name_of(page);
        }
}

TEST(DocsLinks, AStrangersQuestionsAreTwoClicksAway) {
    const auto pages = pages_within(2, kRoot / "README.md");
    for (const char* answer : {
             "## Machines with ssh",            // on 8 nodes?
             "# A scene from Blender",          // my Blender scene?
             "# Units, coordinates, colours",   // where are units and coordinates defined?
             "## A BSDF",                       // how do I add a BSDF?
             "**Guiding is given up below",     // which constant decides that guiding is given up?
             "# Words that are ours",           // what is a quantum?
             "# The log of what was measured",  // where does that figure come from?
             "| `guiding.type` |",              // which keys are there?
         }) {
        const bool found = std::any_of(pages.begin(), pages.end(), [&](const fs::path& page) {
            return fs::exists(page) && test::read_file(page).find(answer) != std::string::npos;
        });
        EXPECT_TRUE(found) << "no page within two clicks of README.md says: " << answer;
    }
}

}  // namespace
}  // namespace treefarm
