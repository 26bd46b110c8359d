// SPDX-License-Identifier: Apache-2.0
// treefarm render resolved.toml: the experiment once more, or a refusal that names what differs.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

class ResolvedCommand : public test::FolderTest {
  protected:
    void SetUp() override {
        fs::create_directory_symlink(fs::path(test::own_scene("")) / "meshes", folder_ / "meshes");
        write("scene.xml", test::read_file(test::own_scene("glossy-room.xml")));
    }

    test::Ended render(const std::string& input, const std::string& run, const std::string& options = "") const {
        return test::run_treefarm("render " + (folder_ / input).string() + " --run-dir " + (folder_ / run).string() +
                                  " " + options);
    }

    void render_first(const std::string& options) const {
        const test::Ended first = render("scene.xml", "first", "-D width=24 -D height=16 " + options);
        ASSERT_EQ(first.code, 0) << first.output;
    }

    /// A resolved.toml that is refused, and why.
    void expect_refusal(const std::string& why, const std::string& options = "") const {
        const test::Ended again = render("first/resolved.toml", "again", options);
        EXPECT_EQ(again.code, 2);
        EXPECT_NE(again.output.find(why), std::string::npos) << again.output;
        EXPECT_FALSE(fs::exists(folder_ / "again"));
    }

    void expect_equal_images() const {
        const test::Ended again = render("first/resolved.toml", "again");
        ASSERT_EQ(again.code, 0) << again.output;
        EXPECT_EQ(summary("again")["image_hash"], summary("first")["image_hash"]);
        EXPECT_EQ(summary("again")["tree_hash"], summary("first")["tree_hash"]);
        EXPECT_EQ(summary("again")["spp"], summary("first")["spp"]);
    }

    /// Replaces the first `from` of a file.
    void edit(const std::string& name, const std::string& from, const std::string& to) const {
        std::string text = test::read_file(folder_ / name);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        write(name, text.replace(at, from.size(), to));
    }

    nlohmann::json summary(const std::string& run) const {
        return nlohmann::json::parse(test::read_file(folder_ / run / "summary.json"));
    }
};

TEST_F(ResolvedCommand, GivesTheImageOnceMore) {
    render_first("--spp 31 --set sampler.seed=3");
    for (const char* absent : {"\nschedule =", "'auto'", "\"auto\""})
        EXPECT_EQ(test::read_file(folder_ / "first/resolved.toml").find(absent), std::string::npos) << absent;
    expect_equal_images();
    EXPECT_EQ(test::read_file(folder_ / "again/resolved.toml"), test::read_file(folder_ / "first/resolved.toml"));
    EXPECT_EQ(test::run_treefarm("plan " + (folder_ / "first/resolved.toml").string() + " --spp 8 --probe 0.2").code, 0)
        << "a probe on another film";
}

TEST_F(ResolvedCommand, AnEditedSceneIsRefused) {
    render_first("--spp 3");
    const std::string hash = summary("first")["scene_hash"];
    expect_refusal("or --set image.width=25 makes another of it", "--set image.width=25");
    edit("scene.xml", "<shape", "<shape type=\"sphere\"><float name=\"radius\" value=\"0.1\"/></shape>\n<shape");
    expect_refusal("experiment.scene_hash was " + hash + ", and is ");
    expect_refusal("the scene has changed since; render job.toml for the scene as it is now");
    EXPECT_EQ(render("first/job.toml", "anew").code, 0);
}

TEST_F(ResolvedCommand, ASceneThatWasMovedOrGotACommentIsTheSame) {
    render_first("--spp 3");
    edit("scene.xml", "<shape", "<!-- a line -->\n\n<shape");
    fs::create_directories(folder_ / "elsewhere");
    fs::rename(folder_ / "scene.xml", folder_ / "elsewhere/scene.xml");
    fs::create_directory_symlink(folder_ / "meshes", folder_ / "elsewhere/meshes");
    const test::Ended again =
        render("first/resolved.toml", "again", "--set scene.file=" + (folder_ / "elsewhere/scene.xml").string());
    ASSERT_EQ(again.code, 0) << again.output;
    EXPECT_EQ(summary("again")["image_hash"], summary("first")["image_hash"]);
}

TEST_F(ResolvedCommand, WhatWasTakenOutIsMissed) {
    render_first("--spp 3");
    const std::string text = test::read_file(folder_ / "first/resolved.toml");
    write("first/resolved.toml", text.substr(0, text.find("[policy.")));
    expect_refusal("policy.guiding.least_judged_spp is not in it");
    write("first/resolved.toml", text);
    edit("first/resolved.toml", "\nversion", "\n#version");
    expect_refusal("experiment.version is not in it");
}

TEST_F(ResolvedCommand, TakesListedPassesFromBesideIt) {
    write("passes.toml",
          "[[pass]]\nspp = 2\nnext_event = true\nrecord = true\n\n[[pass]]\nspp = 7\nnext_event = true\n"
          "record = false\n");
    render_first("--schedule " + (folder_ / "passes.toml").string());
    expect_equal_images();
    EXPECT_EQ(render("again/resolved.toml", "thrice").code, 0);
    EXPECT_EQ(summary("thrice")["image_hash"], summary("first")["image_hash"]);
    EXPECT_EQ(render("first/resolved.toml", "longer", "--spp 31").code, 0) << "a budget of one's own";
    EXPECT_EQ(summary("longer")["spp"], 31);
    fs::remove_all(folder_ / "again");
    fs::remove(folder_ / "first/schedule.toml");
    expect_refusal("first/resolved.toml:7:12: its passes are those of ");
    expect_refusal("which is not there; name it with --schedule FILE");
}

TEST_F(ResolvedCommand, TakesPassesThatTheClockChoseFromBesideIt) {
    render_first("--seconds 0.5");
    expect_equal_images();
    edit("first/resolved.toml", "schedule = \"schedule.toml\"", "");
    fs::remove_all(folder_ / "again");
    expect_refusal("budget.seconds chose the passes, but experiment.schedule does not say where they are");
    EXPECT_EQ(render("first/resolved.toml", "longer", "--spp 3").code, 0) << "a budget of one's own";
}

TEST_F(ResolvedCommand, TakesThePassesOfARenderThatWentOn) {
    render_first("--spp 20");
    const test::Ended more = test::run_treefarm("resume " + (folder_ / "first").string() + " --spp 50");
    ASSERT_EQ(more.code, 0) << more.output;
    expect_equal_images();
}

}  // namespace
}  // namespace treefarm
