// SPDX-License-Identifier: Apache-2.0
// `treefarm plan` with a budget: a probe of the first passes says what the whole render would take.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

using nlohmann::json;

const std::string kBox = test::own_scene("cornell-box.xml") + " -D size=32 --threads 1";

json expected_of(const std::string& arguments) {
    const test::Ended ended = test::run_treefarm("plan " + arguments + " --json");
    EXPECT_EQ(ended.code, 0) << ended.output;
    return json::parse(ended.output).at("expected");
}

bool holds(const json& figure, double value) {
    return figure["low"].get<double>() <= value && value <= figure["high"].get<double>();
}

/// The summary of a render.
json summary_of(const std::string& arguments) {
    const std::filesystem::path folder = test::test_folder() / "run";
    std::filesystem::remove_all(folder);
    const test::Ended ended = test::run_treefarm("render " + arguments + " --quiet --run-dir " + folder.string());
    EXPECT_EQ(ended.code, 0) << ended.output;
    const test::Ended text = test::run_command("cat " + (folder / "summary.json").string());
    return json::parse(text.output);
}

/// The probe ends where a tenth of the samples or fewer are done.
TEST(PlanProbe, IntervalsHoldWhatARenderTakes) {
    int held = 0, seeds = 0;
    double logs = 0;
    for (const char* type : {"none", "auto"})
        for (const int seed : {1, 2, 3, 4}) {
            const std::string scene =
                kBox + " --set guiding.type=" + type + " --set sampler.seed=" + std::to_string(seed);
            const json expected = expected_of(scene + " --error 10% --probe 0.05");
            ASSERT_TRUE(expected["known"].get<bool>()) << expected;
            const double ratio = expected["spp"]["high"].get<double>() / expected["spp"]["low"].get<double>();
            EXPECT_LT(ratio, 50) << expected;
            logs += std::log(ratio);
            const double spp = summary_of(scene + " --error 10%")["spp"].get<double>();
            EXPECT_LT(expected["probe"]["spp"].get<double>(), 0.5 * spp);
            held += holds(expected["spp"], spp);
            ++seeds;
        }
    EXPECT_GE(held, seeds - 2) << "of " << seeds;
    EXPECT_LT(std::exp(logs / seeds), 20) << "intervals say little";
}

TEST(PlanProbe, AnswersForSamplesAndTimeToo) {
    const json counted = expected_of(kBox + " --spp 500 --probe 0.05");
    EXPECT_EQ(counted["spp"]["value"], 500);
    EXPECT_GT(counted["seconds"]["value"].get<double>(), 0);
    EXPECT_GT(counted["error"]["high"].get<double>(), counted["error"]["low"].get<double>());
    const json timed = expected_of(kBox + " --seconds 1h --set budget.max_spp=1073741824 --probe 0.05");
    EXPECT_EQ(timed["seconds"]["value"], 3600);
    EXPECT_GT(timed["spp"]["value"].get<double>(), 500);
    EXPECT_LT(timed["error"]["value"].get<double>(), counted["error"]["value"].get<double>());
    const json capped = expected_of(kBox + " --error 1e-5 --seconds 100 --probe 0.05");
    EXPECT_EQ(capped["ends_by"], "seconds");
    EXPECT_EQ(capped["seconds"]["value"], 100);
    for (const char* asked : {" --error 1e-5", " --seconds 1h", " --error 1e-5 --seconds 1h"}) {
        const json bounded = expected_of(kBox + asked + " --set budget.max_spp=500 --probe 0.05");
        EXPECT_EQ(bounded["ends_by"], "spp") << asked;
        EXPECT_EQ(bounded["spp"]["value"], 500) << asked;
    }
}

TEST(PlanProbe, TextSaysItInItsFirstLine) {
    const test::Ended ended = test::run_treefarm("plan " + kBox + " --error 5% --probe 0.05");
    EXPECT_EQ(ended.code, 0);
    EXPECT_TRUE(ended.output.starts_with("treefarm: probing for 0.05 s\n5 % error: about ")) << ended.output;
    EXPECT_NE(ended.output.find(" on this machine (1 thread)\n"), std::string::npos) << ended.output;
    EXPECT_LT(ended.output.find("5 % error"), ended.output.find("memory expected: "));
    EXPECT_EQ(ended.output.find("effects on"), std::string::npos);
}

/// Other estimators are recommended by a figure alone.
TEST(PlanProbe, ComparesTheEstimatorThatMaySuitTheScene) {
    const test::Ended ended = test::run_treefarm("plan " + test::own_scene("door-ajar.xml") +
                                                 " --set image.width=32 --set image.height=24 --threads 1 --error 20% "
                                                 "--probe 0.05");
    EXPECT_EQ(ended.code, 0) << ended.output;
    EXPECT_NE(ended.output.find("probing bidirectional for "), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("] times as fast as path to equal error"), std::string::npos) << ended.output;
}

TEST(PlanProbe, FramesAreProbedAtBothEndsAndInTheMiddle) {
    const json expected = expected_of(kBox + " --frames 1-9 --error 10% --probe 0.05");
    EXPECT_EQ(expected["frames"], 9);
    ASSERT_EQ(expected["probed"].size(), 3u);
    double probed[3] = {}, low = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(expected["probed"][k]["frame"], 1 + 4 * k);
        probed[k] = expected["probed"][k]["seconds"]["value"];
        low += expected["probed"][k]["seconds"]["low"].get<double>();
    }
    // Trapezia of four steps each, with both ends.
    EXPECT_NEAR(expected["seconds"]["value"].get<double>(), 2.5 * probed[0] + 4 * probed[1] + 2.5 * probed[2], 1e-9);
    EXPECT_LT(expected["seconds"]["low"].get<double>(), expected["seconds"]["value"].get<double>());
    EXPECT_GT(expected["seconds"]["low"].get<double>(), low);
    EXPECT_NEAR(expected_of(kBox + " --frames 7 --seconds 100 --probe 0.05")["seconds"]["value"].get<double>(), 100,
                1e-9);
    EXPECT_EQ(expected_of(kBox + " --frames 1,2 --seconds 100 --probe 0.05")["seconds"]["low"], 200);
    EXPECT_EQ(test::run_treefarm("plan " + kBox + " --frames 3-1").code, 2);
    EXPECT_EQ(test::run_treefarm("plan " + kBox + " --frames 1-3 --no-probe").code, 2);
}

/// Larger films are probed on smaller ones.
TEST(PlanProbe, ALargeFilmTakesNoLonger) {
    const json expected = expected_of(test::own_scene("cornell-box.xml") + " -D size=8192 --spp 4");
    EXPECT_NEAR(expected["probe"]["pixel_ratio"].get<double>(), 512, 4);
}

TEST(PlanProbe, WithoutOneOnlyTheRestIsKnown) {
    const test::Ended text = test::run_treefarm("plan " + kBox + " --error 5% --no-probe");
    EXPECT_EQ(text.code, 0);
    EXPECT_TRUE(text.output.starts_with("seconds and error are not known without a probe")) << text.output;
    EXPECT_FALSE(json::parse(test::run_treefarm("plan " + kBox + " --json").output).contains("expected"))
        << "who does not ask is not kept waiting";
}

TEST(PlanProbe, WritesNothing) {
    const std::filesystem::path folder = test::fresh_test_folder();
    const test::Ended ended = test::run_command("cd " + folder.string() + " && '" TREEFARM_PROGRAM "' plan " + kBox +
                                                " --spp 500 --probe 0.05 --set output.file=image.exr");
    EXPECT_EQ(ended.code, 0) << ended.output;
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

class PlanProbeScene : public test::MitsubaFixture {
  protected:
    std::string scene(const std::string& emitter, const std::string& error = "5%") const {
        return write(
                   "scene.xml",
                   "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><integer "
                   "name=\"width\" value=\"16\"/><integer name=\"height\" value=\"16\"/></film><transform "
                   "name=\"toWorld\"><lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/></transform></sensor>"
                   "<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"100\"/></transform></shape>" +
                       emitter + "</scene>")
                   .string() +
               " --threads 1 --error " + error;
    }
};

TEST_F(PlanProbeScene, WithoutLightNothingIsKnown) {
    const json expected = expected_of(scene("") + " --probe 0.2");
    EXPECT_FALSE(expected["known"].get<bool>());
    EXPECT_NE(expected["why"].get<std::string>().find("no light"), std::string::npos);
}

TEST_F(PlanProbeScene, ASignalEndsIt) {
    const test::Ended ended =
        test::run_command("timeout --signal=INT --preserve-status 1 '" TREEFARM_PROGRAM "' plan " +
                          scene("<emitter type=\"constant\"/>", "1e-6") +
                          " --set guiding.spp_unit=65536 --set image.width=512 --set image.height=512 --probe 1h");
    EXPECT_EQ(ended.code, 3) << ended.output;
    EXPECT_NE(ended.output.find("interrupted"), std::string::npos) << ended.output;
}

}  // namespace
}  // namespace treefarm
