// SPDX-License-Identifier: Apache-2.0
#include "tests/support/markdown.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <regex>

namespace treefarm::test {

namespace {

namespace fs = std::filesystem;

bool is_mark(unsigned char c) {
    return c < 128 && std::isalnum(c) == 0 && c != '-' && c != '_';
}

std::string slug(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == ' ')
            anchor += '-';
        else if (!is_mark(byte))
            anchor += static_cast<char>(byte < 128 ? std::tolower(byte) : byte);
    }
    return anchor;
}

/// Text with each link replaced by its words.
std::string without_links(const std::string& text) {
    static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
    return std::regex_replace(text, link, "$1");
}

}  // namespace

std::vector<fs::path> markdown_pages() {
    const fs::path root = TREEFARM_SOURCE_DIR;
    std::vector<fs::path> pages;
    for (const auto& entry : fs::directory_iterator(root))
        if (entry.path().extension() == ".md") pages.push_back(entry.path());
    for (const char* folder : {"docs", "bench/log"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder))
            if (entry.path().extension() == ".md") pages.push_back(entry.path());
    std::sort(pages.begin(), pages.end());
    return pages;
}

std::vector<MarkdownLine> markdown_lines(const fs::path& page) {
    std::ifstream file(page);
    std::vector<MarkdownLine> lines;
    bool fenced = false;
    for (std::string text; std::getline(file, text);) {
        const bool fence = text.find_first_not_of(' ') == text.find("```") && text.find("```") != std::string::npos;
        if (fence) fenced = !fenced;
        lines.push_back({static_cast<int>(lines.size()) + 1, text, fenced || fence});
    }
    return lines;
}

std::vector<std::string> headings(const fs::path& page) {
    static const std::regex heading(R"(#{1,6} +(.*?) *)");
    std::vector<std::string> found;
    std::smatch match;
    for (const MarkdownLine& line : markdown_lines(page))
        if (!line.fenced && std::regex_match(line.text, match, heading)) found.push_back(match[1]);
    return found;
}

std::vector<std::string> anchors(const fs::path& page) {
    std::vector<std::string> found;
    std::map<std::string, int> times;
    for (const std::string& heading : headings(page)) {
        const std::string anchor = slug(without_links(heading));
        const int before = times[anchor]++;
        found.push_back(before == 0 ? anchor : anchor + "-" + std::to_string(before));
    }
    return found;
}

std::vector<MarkdownLink> local_links(const fs::path& page) {
    static const std::regex code("`[^`]*`"), link(R"(\]\(([^)\s]*)\))"), web("[a-z]+:.*");
    std::vector<MarkdownLink> links;
    for (const MarkdownLine& line : markdown_lines(page)) {
        if (line.fenced) continue;
        const std::string text = std::regex_replace(line.text, code, "");
        for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
            const std::string target = (*it)[1];
            if (std::regex_match(target, web)) continue;
            const std::size_t hash = std::min(target.find('#'), target.size());
            links.push_back({line.number, target.substr(0, hash), target.substr(std::min(hash + 1, target.size()))});
        }
    }
    return links;
}

}  // namespace treefarm::test
