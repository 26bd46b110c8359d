// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm::test {

/// Markdown pages of the source tree: those of its root, of docs/ and of bench/log.
std::vector<std::filesystem::path> markdown_pages();

/// A line of a page.
struct MarkdownLine {
    int number = 0;  ///< from 1 on
    std::string text;
    bool fenced = false;  ///< within a ``` fence
};
std::vector<MarkdownLine> markdown_lines(const std::filesystem::path& page);

/// Headings of a page in order, without their # marks.
std::vector<std::string> headings(const std::filesystem::path& page);

/// Anchors that GitHub gives to a page's headings.
std::vector<std::string> anchors(const std::filesystem::path& page);

/// A link of a page, with its target.
struct MarkdownLink {
    int line = 0;        ///< line on which it ends
    std::string path;    ///< relative to the page; empty: the page itself
    std::string anchor;  ///< without #; empty: none
};
/// Links and pictures with targets in the source tree rather than on the web.
std::vector<MarkdownLink> local_links(const std::filesystem::path& page);

}  // namespace treefarm::test
