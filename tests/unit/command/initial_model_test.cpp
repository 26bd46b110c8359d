// SPDX-License-Identifier: Apache-2.0
// guiding.initial_model: a render that begins with what another has learned.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/config/job_reader.h"
#include "common/plan/resolve/resolved_file.h"
#include "tests/support/command.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

class InitialModel : public test::FolderTest {
  protected:
    /// The frame that the others begin with.
    void SetUp() override {
        const test::Ended first = render("first", "--set guiding.type=ppg");
        ASSERT_EQ(first.code, 0) << first.output;
    }

    test::Ended render(const std::string& run, const std::string& options, int spp = 63) const {
        return test::run_treefarm("render " + test::own_scene("glossy-room.xml") +
                                  " -D width=24 -D height=16 --set guiding.spatial_threshold=200 --run-dir " +
                                  (folder_ / run).string() + " --spp " + std::to_string(spp) + " " + options);
    }

    std::string from(const std::string& run) const {
        return "--set guiding.initial_model=" + (folder_ / run).string() + " ";
    }

    nlohmann::json summary(const std::string& run) const {
        return nlohmann::json::parse(test::read_file(folder_ / run / "summary.json"));
    }
};

TEST_F(InitialModel, GuidesFromTheFirstPassOnAndIsTaughtByLongOnesOnly) {
    const test::Ended ended = render("second", "--set guiding.type=ppg --set sampler.seed=1 " + from("first"));
    ASSERT_EQ(ended.code, 0) << ended.output;
    const Job job = read_resolved(test::read_file(folder_ / "second/resolved.toml"), "resolved.toml");
    EXPECT_EQ(job.guiding.initial_model_hash, summary("first")["tree_file_hash"]);
    EXPECT_EQ(job.guiding.initial_model_spp, 16) << "1 2 4 8 16 teach, the last of 32 does not";
    const nlohmann::json passes = summary("second")["passes"];
    EXPECT_EQ(passes[0]["tree_regions"], summary("first")["passes"].back()["tree_regions"]);
    const std::string schedule = test::read_file(folder_ / "second/schedule.toml");
    std::size_t teaching = 0;
    for (std::size_t at = 0; (at = schedule.find("record = true", at)) != std::string::npos; ++at)
        ++teaching;
    EXPECT_EQ(teaching, 1u) << schedule;
    EXPECT_NE(summary("second")["image_hash"], summary("first")["image_hash"]);
}

TEST_F(InitialModel, TheSameModelGivesTheSameBits) {
    const std::string options = "--set guiding.type=ppg --set sampler.seed=2 " + from("first");
    ASSERT_EQ(render("third", options).code, 0);
    const test::Ended again = test::run_treefarm("render " + (folder_ / "third/resolved.toml").string() +
                                                 " --run-dir " + (folder_ / "again").string());
    ASSERT_EQ(again.code, 0) << again.output;
    EXPECT_EQ(summary("again")["image_hash"], summary("third")["image_hash"]);
    EXPECT_EQ(summary("again")["tree_hash"], summary("third")["tree_hash"]);
}

TEST_F(InitialModel, ARenderThatBeganWithOneGoesOnWithoutIt) {
    ASSERT_EQ(render("base", "--set guiding.type=ppg --set sampler.seed=4").code, 0);
    ASSERT_EQ(render("grown", "--set guiding.type=ppg --set sampler.seed=3 " + from("base")).code, 0);
    fs::remove_all(folder_ / "base");
    const test::Ended ended = test::run_treefarm("resume " + (folder_ / "grown").string() + " --spp 100");
    EXPECT_EQ(ended.code, 0) << ended.output;
    EXPECT_EQ(summary("grown")["spp"], 100);
}

TEST_F(InitialModel, OneThatTaughtNothingHandsOnWhatItBeganWith) {
    ASSERT_EQ(render("second", "--set guiding.type=ppg " + from("first"), 15).code, 0)
        << "passes of 1 2 4 8 teach nothing";
    ASSERT_EQ(render("third", "--set guiding.type=ppg " + from("second"), 15).code, 0);
    const Job job = read_resolved(test::read_file(folder_ / "third/resolved.toml"), "resolved.toml");
    EXPECT_EQ(job.guiding.initial_model_spp, 16);
    EXPECT_FALSE(job.guiding.initial_model_hash.empty());
    EXPECT_GT(summary("third")["passes"][0]["tree_regions"], 1);
}

TEST_F(InitialModel, AnotherGuidesModelIsRefused) {
    const test::Ended ended = render("other", "--set guiding.type=view " + from("first"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.output.find("its model is another guide's: guiding.type was \"ppg\", is \"view\""),
              std::string::npos)
        << ended.output;
    EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(InitialModel, AnotherModelThanTheJobSaysIsRefused) {
    const test::Ended ended =
        render("changed", "--set guiding.type=ppg --set guiding.initial_model_hash=0123456789abcdef " + from("first"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.output.find("is not the model that guiding.initial_model_hash says"), std::string::npos)
        << ended.output;
}

TEST_F(InitialModel, WhatIsNoRunDirectoryIsRefused) {
    const test::Ended ended = render("lost", "--set guiding.type=ppg " + from("nowhere"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.output.find("nowhere: is no run directory"), std::string::npos) << ended.output;
}

TEST_F(InitialModel, ARenderThatLearnedNothingIsAWarning) {
    ASSERT_EQ(render("short", "--set guiding.type=ppg", 1).code, 0);
    const test::Ended ended = render("bare", "--set guiding.type=ppg " + from("short"));
    EXPECT_EQ(ended.code, 0) << ended.output;
    EXPECT_NE(ended.output.find("has no model to begin with: it has learned none"), std::string::npos) << ended.output;
    EXPECT_EQ(summary("bare")["image_hash"], summary("first")["image_hash"]);
}

TEST_F(InitialModel, ADamagedModelIsRefused) {
    fs::copy(folder_ / "first", folder_ / "damaged", fs::copy_options::recursive);
    fs::resize_file(folder_ / "damaged/tree.bin", fs::file_size(folder_ / "damaged/tree.bin") / 2);
    const test::Ended ended = render("of-damaged", "--set guiding.type=ppg " + from("damaged"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.output.find("damaged/tree.bin: "), std::string::npos) << ended.output;
}

}  // namespace
}  // namespace treefarm
