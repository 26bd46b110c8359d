#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/support.h"

namespace treefarm {
namespace {

struct Ended {
    int code = -1;
    std::string output;
};

Ended run(const std::string& arguments) {
    const std::string command = std::string(TREEFARM_PROGRAM) + " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    Ended ended;
    if (!pipe) return ended;
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        ended.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ended;
}

Ended plan(const std::string& arguments) {
    return run("plan " + arguments);
}

std::string box() {
    return test::own_scene("cornell-box.xml");
}

TEST(PlanCommand, TellsWhatASceneAndAJobCallFor) {
    const Ended scene = plan(box());
    EXPECT_EQ(scene.code, 0);
    EXPECT_NE(scene.output.find("effects on"), std::string::npos);
    EXPECT_NE(scene.output.find("kernels"), std::string::npos);
    const Ended job = plan(std::string(TREEFARM_SOURCE_DIR) + "/configs/jobs/door-ajar.toml --json");
    EXPECT_EQ(job.code, 0);
    const nlohmann::json json = nlohmann::json::parse(job.output);
    EXPECT_EQ(json["spp"], 508);
    EXPECT_EQ(json["effects"][0]["name"], "next_event");
}

TEST(Program, NamesTheNearestCommand) {
    const Ended wrong = run("rander x.xml");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_EQ(wrong.output, "treefarm: no command is called \"rander\"; did you mean \"render\"?\n");
    EXPECT_EQ(run("xyz").output, "treefarm: no command is called \"xyz\"; see treefarm --help\n");
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
        const Ended ended = plan(arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
    }
    EXPECT_NE(plan(box() + " --set effects.bumb=false").output.find("did you mean effects.bump?"), std::string::npos);
}

}  // namespace
}  // namespace treefarm
