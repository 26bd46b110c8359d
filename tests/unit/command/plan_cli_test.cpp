// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/command.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

test::Ended plan(const std::string& arguments) {
    return test::run_treefarm("plan " + arguments);
}

std::string box() {
    return test::own_scene("cornell-box.xml");
}

TEST(PlanCommand, TellsWhatASceneAndAJobCallFor) {
    const test::Ended scene = plan(box());
    EXPECT_EQ(scene.code, 0);
    EXPECT_NE(scene.output.find("\nmemory expected: each worker "), std::string::npos) << scene.output;
    EXPECT_LT(std::count(scene.output.begin(), scene.output.end(), '\n'), 8) << "lists are -v's: " << scene.output;
    const test::Ended lists = plan(box() + " -v");
    EXPECT_NE(lists.output.find("\neffects on\n"), std::string::npos);
    EXPECT_NE(lists.output.find("\nkernels\n"), std::string::npos);
    EXPECT_EQ(lists.output.find("in the program"), std::string::npos);
    const test::Ended job = plan(std::string(TREEFARM_SOURCE_DIR) + "/configs/jobs/door-ajar.toml --json");
    EXPECT_EQ(job.code, 0);
    const nlohmann::json json = nlohmann::json::parse(job.output);
    EXPECT_EQ(json["spp"], 508);
    EXPECT_EQ(json["effects"][0]["name"], "next_event");
}

TEST(PlanCommand, RecommendsNothingThatItHasNotMeasured) {
    const std::string text = plan(test::own_scene("door-ajar.xml")).output;
    EXPECT_NE(text.find("path and bidirectional can be compared by a probe ("), std::string::npos) << text;
    EXPECT_EQ(text.find("integrator.type="), std::string::npos) << text;
    EXPECT_EQ(plan(box()).output.find("bidirectional"), std::string::npos);
}

TEST(Program, HelpIsACommandToo) {
    EXPECT_EQ(test::run_treefarm("help").output, test::run_treefarm("--help").output);
    EXPECT_EQ(test::run_treefarm("help plan").output, test::run_treefarm("plan --help").output);
    EXPECT_EQ(test::run_treefarm("help").code, 0);
    EXPECT_EQ(test::run_treefarm("help nothing").code, 2);
}

TEST(Program, NamesTheNearestCommand) {
    const test::Ended wrong = test::run_treefarm("rander x.xml");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_EQ(wrong.output, "treefarm: no command is called \"rander\"; did you mean \"render\"?\n");
    EXPECT_EQ(test::run_treefarm("xyz").output, "treefarm: no command is called \"xyz\"; see treefarm --help\n");
}

TEST(PlanCommand, SaysWhereSamplesAreRounded) {
    const nlohmann::json json = nlohmann::json::parse(plan(box() + " --json --spp 1 --set guiding.spp_unit=4").output);
    EXPECT_EQ(json["warnings"].back(), "1 spp become 4: passes take multiples of guiding.spp_unit = 4");
    EXPECT_EQ(plan(box() + " --set integrator.max_depth=-1 --set integrator.rr_depth=20000").code, 2);
}

TEST(PlanCommand, FollowsSettingsAndDefinitions) {
    const nlohmann::json json =
        nlohmann::json::parse(plan(box() + " --json --spp 1 -D size=32 --set guiding.type=none").output);
    EXPECT_EQ(json["width"], 32);
    EXPECT_EQ(json["passes"], 1);
    for (const auto& effect : json["effects"])
        if (effect["name"] == "guiding") {
            EXPECT_FALSE(effect["on"].get<bool>());
            EXPECT_EQ(effect["bytes"], 0);
        }
}

TEST(PlanCommand, MisuseEndsWith2AndOneLine) {
    for (const std::string& arguments :
         {std::string(""), std::string("nowhere.xml"), std::string("\"\""), box() + " --frobnicate",
          box() + " --set effects.bump=true", box() + " --set effects.bumb=false", box() + " --set effects.bump",
          box() + " --set budget.spp=none", std::string(TREEFARM_SOURCE_DIR) + "/README.md"}) {
        const test::Ended ended = plan(arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
    }
    EXPECT_NE(plan(box() + " --set effects.bumb=false").output.find("did you mean effects.bump?"), std::string::npos);
}

}  // namespace
}  // namespace treefarm
