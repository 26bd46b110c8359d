// SPDX-License-Identifier: Apache-2.0
// Commands, settings and scenes that pages show are those of this program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/image/exr.h"
#include "tests/support/command.h"
#include "tests/support/markdown.h"
#include "tests/support/source_root.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

using test::kRoot;
const std::string kProgram = TREEFARM_PROGRAM;

/// A command that a page shows: "render" and what stands behind it.
struct Command {
    std::string where, name, arguments;
};

/// Commands of all pages but frozen ones and the changelog, which speaks of the past.
std::vector<Command> commands() {
    static const std::regex command(
        R"(\btreefarm (?:(launch)\b([^#`|&;]*?)--(?= |$) *)?(render|plan|check|compare|convert|inspect|study|resume|join|serve|report|keys)\b([^#`|&;]*))");
    std::vector<Command> found;
    for (const fs::path& page : test::markdown_pages()) {
        const std::string name = fs::relative(page, kRoot).string();
        if (name.starts_with("bench/log") || name == "CHANGELOG.md") continue;
        for (const test::MarkdownLine& line : test::markdown_lines(page))
            for (std::sregex_iterator it(line.text.begin(), line.text.end(), command), end; it != end; ++it) {
                const std::string where = name + ":" + std::to_string(line.number);
                if ((*it)[1].matched) found.push_back({where, (*it)[1], (*it)[2]});
                found.push_back({where, (*it)[3], (*it)[4]});
            }
    }
    return found;
}

/// Options among a command's arguments, without their values.
std::vector<std::string> options(const std::string& arguments) {
    static const std::regex option(R"((?:^|[ \[])(--[a-z][a-z-]*|-[a-zA-Z](?= |$)))");
    std::vector<std::string> found;
    for (std::sregex_iterator it(arguments.begin(), arguments.end(), option), end; it != end; ++it)
        found.push_back((*it)[1]);
    return found;
}

/// Whether a command's --help lists an option.
bool lists(const std::string& help, const std::string& option) {
    return std::regex_search(help, std::regex("(^|[ ,\\n])" + option + "([ ,\\n]|$)"));
}

TEST(DocsCommands, OptionsAreThoseOfTheProgram) {
    std::map<std::string, std::string> help;
    std::size_t count = 0;
    for (const Command& command : commands()) {
        std::string& text = help[command.name];
        if (text.empty()) text = test::run_command(kProgram + " " + command.name + " --help").output;
        for (const std::string& option : options(command.arguments)) {
            ++count;
            EXPECT_TRUE(lists(text, option)) << command.where << ": treefarm " << command.name << " has no " << option;
        }
    }
    EXPECT_GT(count, 30u);
    EXPECT_FALSE(lists(help["render"], "--frame"));
    EXPECT_TRUE(lists(help["render"], "-D"));
}

TEST(DocsCommands, SettingsAreAccepted) {
    static const std::regex setting(R"(--set ([a-z_]+\.[a-z_]+=[^ `;)]*[^ `,;)]))");
    std::set<std::string> settings;
    for (const fs::path& page : test::markdown_pages()) {
        if (fs::relative(page, kRoot).string().starts_with("bench/log")) continue;
        for (const test::MarkdownLine& line : test::markdown_lines(page))
            for (std::sregex_iterator it(line.text.begin(), line.text.end(), setting), end; it != end; ++it)
                if ((*it)[1].str().find('$') == std::string::npos)
                    settings.insert(std::regex_replace((*it)[1].str(), std::regex("%d"), "7"));  // of a frame
    }
    EXPECT_GT(settings.size(), 8u);
    const std::string plan = kProgram + " plan '" + (kRoot / "configs/scenes/cornell-box.xml").string() + "' --set '";
    for (const std::string& text : settings) {
        const test::Ended ended = test::run_command(plan + text + "'");
        EXPECT_EQ(ended.code, 0) << text << ": " << ended.output;
    }
}

/// Fenced scenes of the pages for users.
std::vector<std::pair<std::string, std::string>> scenes() {
    std::vector<std::pair<std::string, std::string>> found;
    for (const fs::path& page : test::markdown_pages()) {
        std::string scene;
        for (const test::MarkdownLine& line : test::markdown_lines(page)) {
            if (line.fenced && line.text.starts_with("<scene ")) scene = " ";
            if (!scene.empty()) scene += line.text + "\n";
            if (line.text.starts_with("</scene>"))
                found.emplace_back(page.filename().string(), std::exchange(scene, ""));
        }
    }
    return found;
}

TEST(DocsCommands, ScenesAreRead) {
    const fs::path folder = test::test_folder();
    fs::copy_file(kRoot / "configs/scenes/meshes/vase.obj", folder / "room.obj", fs::copy_options::overwrite_existing);
    ASSERT_FALSE(scenes().empty());
    for (const auto& [page, text] : scenes()) {
        std::ofstream(folder / "scene.xml") << text;
        const test::Ended ended = test::run_command(kProgram + " plan '" + (folder / "scene.xml").string() + "'");
        EXPECT_EQ(ended.code, 0) << page << ": " << ended.output;
    }
}

/// Fenced studies of a page.
std::vector<std::string> studies(const fs::path& page) {
    std::vector<std::string> found;
    bool inside = false;
    for (const test::MarkdownLine& line : test::markdown_lines(page)) {
        if (line.text.starts_with("```toml")) {
            inside = true;
            found.emplace_back();
        } else if (!line.fenced || line.text.starts_with("```")) {
            inside = false;
        } else if (inside) {
            found.back() += line.text + "\n";
        }
    }
    return found;
}

TEST(DocsCommands, StudiesAreRead) {
    const fs::path folder = test::test_folder();
    fs::create_directories(folder / "studies");
    fs::create_directories(folder / "scenes");
    fs::copy_file(kRoot / "configs/scenes/cornell-box.xml", folder / "scenes/cornell-box.xml",
                  fs::copy_options::overwrite_existing);
    Image reference{64, 96, {}, {}};
    for (const char* const channel : {"R", "G", "B"})
        reference.add_channel(channel);
    write_exr(folder / "studies/box.exr", reference);
    const std::vector<std::string> shown = studies(kRoot / "docs/use/studies.md");
    ASSERT_FALSE(shown.empty());
    for (const std::string& text : shown) {
        const fs::path file = folder / "studies/mine.toml";
        std::ofstream(file) << text;
        const test::Ended ended = test::run_command("cd '" + folder.string() + "' && " + kProgram + " study '" +
                                                    file.string() + "' --dry-run --no-probe");
        EXPECT_EQ(ended.code, 0) << text << ended.output;
    }
}

}  // namespace
}  // namespace treefarm
