// SPDX-License-Identifier: Apache-2.0
// `treefarm inspect` on small renders.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "common/image/exr.h"
#include "tests/support/command.h"
#include "tests/support/read_ldr.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

class InspectCommand : public test::FolderTest {
  protected:
    void render(const std::string& arguments) {
        const test::Ended ended =
            test::run_treefarm("render --quiet --threads 2 --overwrite --run-dir " + run_ + " " + arguments);
        ASSERT_EQ(ended.code, 0) << ended.output;
    }

    nlohmann::json inspect(const std::string& arguments) {
        const test::Ended ended = test::run_treefarm("inspect " + run_ + " --json " + arguments);
        EXPECT_EQ(ended.code, 0) << ended.output;
        return nlohmann::json::parse(ended.output, nullptr, false);
    }

    void expect_refused(const std::string& arguments, const std::string& why) {
        const test::Ended ended = test::run_treefarm("inspect " + arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
        EXPECT_NE(ended.output.find(why), std::string::npos) << ended.output;
    }

    static std::string furnace(const std::string& options) {
        return test::own_scene("white-furnace.xml") + " -D size=16 --spp 63 --set guiding.type=ppg " + options;
    }

    const std::string run_ = path("run");
};

TEST_F(InspectCommand, FindsTheKnownRadianceOfTheFurnace) {
    render(furnace("--set integrator.next_event=never"));
    const nlohmann::json found = inspect("--pixel 3,5 --point 0,0,0 --point 0.5,0,0:0,1,0 --size 16 --spp 256");
    ASSERT_EQ(found["places"].size(), 3u);
    // Radiance 2 arrives from everywhere, half of it is reflected.
    EXPECT_NEAR(found["places"][0]["reflected"].get<double>(), 1.0, 0.02);
    EXPECT_GT(found["places"][0]["pictures"][0]["overlap"].get<double>(), 0.6) << "a region has more normals than one";
    EXPECT_EQ(found["places"][1]["pictures"].size(), 1u) << "nothing is reflected at a bare point";
    for (const auto& point : found["places"])
        for (const auto& picture : point["pictures"]) {
            EXPECT_EQ(picture["panels"].size(), 2u) << "without next event nothing is left out";
            const Image image = read_ldr(picture["file"].get<std::string>(), Encoding::srgb);
            EXPECT_EQ(image.height, 256);
            EXPECT_EQ(image.width, 2 * 256 + 8);
        }
    EXPECT_EQ(found["tree"]["stored_bytes"], fs::file_size(run_ + "/tree.bin"));
    EXPECT_EQ(found["tree"]["views"], 0);
}

TEST_F(InspectCommand, ShowsWhatNextEventLeaves) {
    render(furnace("--set integrator.next_event=always"));
    const nlohmann::json found = inspect("--pixel 3,5 --size 16 --spp 16");
    EXPECT_NEAR(found["places"][0]["reflected"].get<double>(), 1.0, 0.05);
    const auto& panels = found["places"][0]["pictures"][0]["panels"];
    ASSERT_EQ(panels.size(), 3u);
    EXPECT_EQ(panels[1], "incident radiance left by next event");
}

TEST_F(InspectCommand, TheTruthIsWhatThePixelShows) {
    struct Case {
        const char* scene;
        int x, y;  ///< sees a plain wall
    };
    for (const Case& c :
         {Case{"cornell-box.xml -D size=32", 4, 12}, Case{"glossy-room.xml -D width=48 -D height=32", 35, 15}}) {
        // Enough samples: at 255 spp nine pixels of the glossy room deviate by 4 % (one standard error).
        render(test::own_scene("") + c.scene + " --spp 1023 --set guiding.type=ppg");
        const RgbImage image = read_exr_rgb(run_ + "/image.exr").image;
        const nlohmann::json found = inspect("--spp 16 --pixel " + std::to_string(c.x) + "," + std::to_string(c.y));
        double shown = 0;  // of the neighbours, too: the image is noisy
        for (int y = c.y - 1; y <= c.y + 1; ++y)
            for (int x = c.x - 1; x <= c.x + 1; ++x)
                shown += static_cast<double>(average(image.pixels[static_cast<std::size_t>(y * image.width + x)])) / 9;
        EXPECT_NEAR(found["places"][0]["reflected"].get<double>(), shown, 0.1 * shown) << c.scene;
    }
}

TEST_F(InspectCommand, ShowsViewsAndTheFilmWithTheSameBitsForAnyThreads) {
    // As published every glossy surface has views; learned ones go where they gain nothing.
    render(test::own_scene("glossy-room.xml") +
           " -D width=96 -D height=64 --spp 63 --set guiding.type=view --set guiding.view_records=radiance"
           " --set guiding.bsdf_fraction=0.5");
    std::string pixels = "--maps --size 16 --spp 8";
    for (int k = 0; k < 24; ++k)
        pixels += " --pixel " + std::to_string(6 + 12 * (k % 8)) + "," + std::to_string(20 + 18 * (k / 8));
    const nlohmann::json one = inspect(pixels + " --threads 1");
    std::vector<std::string> pictures;
    for (const auto& entry : fs::directory_iterator(run_ + "/inspect"))
        pictures.push_back(test::read_file(entry.path()));
    EXPECT_EQ(one, inspect(pixels + " --threads 2"));
    std::size_t k = 0;
    for (const auto& entry : fs::directory_iterator(run_ + "/inspect"))
        EXPECT_EQ(test::read_file(entry.path()), pictures.at(k++)) << entry.path();
    EXPECT_GT(one["tree"]["views"], 0);
    EXPECT_GT(one["tree"]["t2_share"], 0.0);
    bool has_view = false;
    for (const auto& point : one["places"])
        for (const auto& picture : point["pictures"])
            has_view |= picture["kind"] == "t2" && fs::exists(picture["file"].get<std::string>());
    EXPECT_TRUE(has_view);
    ASSERT_EQ(one["maps"].size(), 4u);
    for (const auto& map : one["maps"])
        EXPECT_EQ(read_ldr(map["file"].get<std::string>(), Encoding::srgb).width, 96) << map;
    render(test::own_scene("white-furnace.xml") + " -D size=16 --spp 1 --set guiding.type=none");
    EXPECT_FALSE(fs::exists(run_ + "/inspect")) << "pictures of another run's tree";
}

TEST_F(InspectCommand, PrintsStatistics) {
    render(furnace(""));
    const test::Ended ended = test::run_treefarm("inspect " + run_);
    EXPECT_EQ(ended.code, 0);
    for (const char* word : {"regions in", "bytes stored", "a_BSDF", "a_T1", "cells of T1", "no T2"})
        EXPECT_NE(ended.output.find(word), std::string::npos) << word << " in " << ended.output;
    EXPECT_FALSE(fs::exists(run_ + "/inspect"));
}

TEST_F(InspectCommand, RefusesWhatIsMissingOrDoesNotMatch) {
    expect_refused(run_, "is no run directory");
    render(furnace("--set guiding.type=none"));
    expect_refused(run_, "tree.bin: is missing, since guiding.type is \"none\"");
    render(test::own_scene("white-furnace.xml") + " -D size=16 --spp 1 --set guiding.type=ppg");
    expect_refused(run_, "tree.bin: is missing, since no pass had taught the tree");
    const fs::path scene = folder_ / "scene.xml";
    fs::copy_file(test::own_scene("white-furnace.xml"), scene);
    render(scene.string() + " -D size=16 --spp 15 --set guiding.type=ppg");
    for (const auto& [arguments, why] :
         std::vector<std::pair<std::string, std::string>>{{"--pixel 16,0", "is no pixel"},
                                                          {"--pixel 1", "is no pixel"},
                                                          {"--pixel 1.5,2", "is no pixel"},
                                                          {"--point 1,2", "is no point"},
                                                          {"--point 1,2,x", "is no point"},
                                                          {"--point 1,2,3000", "is outside"},
                                                          {"--point 0,0,0:0,0,0", "a normal without direction"},
                                                          {"--size 33 --pixel 1,1", "no power of two"}})
        expect_refused(run_ + " " + arguments, why);
    std::string text = test::read_file(scene);
    text.replace(text.find("value=\"1\""), 9, "value=\"3\"");
    std::ofstream(scene) << text;
    expect_refused(run_, "it has changed since");
    std::ofstream(run_ + "/tree.bin", std::ios::app) << "x";
    expect_refused(run_, "is not the tree that summary.json stands beside");
    fs::remove(run_ + "/tree.bin");
    expect_refused(run_, "tree.bin: is missing, though the run wrote it");
    fs::remove(run_ + "/summary.json");
    expect_refused(run_, "summary.json: is missing");
}

}  // namespace
}  // namespace treefarm
