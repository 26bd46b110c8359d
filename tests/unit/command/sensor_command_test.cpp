// SPDX-License-Identifier: Apache-2.0
// Sensors, crop windows and black images as a user meets them.
#include <ImathBox.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/image/exr.h"
#include "tests/support/command.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using test::Ended;
using test::run_treefarm;

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A lit sphere, seen from the front and, from closer by, from the side.
class SensorCommand : public test::MitsubaFixture {
  protected:
    std::string scene(const std::string& film, const std::string& name = "scene.xml",
                      const std::string& version = "3.0.0") const {
        const auto sensor = [&](const std::string& id, const std::string& origin) {
            return "<sensor type=\"perspective\" id=\"" + id + "\"><transform name=\"to_world\"><lookat origin=\"" +
                   origin +
                   "\" target=\"0,0,0\" up=\"0,1,0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" "
                   "value=\"24\"/><integer name=\"height\" value=\"16\"/>" +
                   film + "</film></sensor>\n";
        };
        return write(name, "<scene version=\"" + version + "\">\n" + sensor("front", "0,0,6") +
                               sensor("side", "3,0,0") + "<shape type=\"sphere\"/><emitter type=\"constant\"/></scene>")
            .string();
    }

    Ended render(const std::string& input, const std::string& run, const std::string& more = "") const {
        return run_treefarm("render '" + input + "' --spp 7 --threads 2 --overwrite --run-dir '" +
                            (folder_ / run).string() + "' " + more);
    }

    std::string hash(const std::string& run) const {
        std::ifstream file(folder_ / run / "summary.json");
        return nlohmann::json::parse(file).at("image_hash");
    }
};

const std::string kCrop =
    "<integer name=\"crop_offset_x\" value=\"9\"/><integer name=\"crop_offset_y\" value=\"3\"/>"
    "<integer name=\"crop_width\" value=\"11\"/><integer name=\"crop_height\" value=\"7\"/>";

TEST_F(SensorCommand, ChoosesAndRepeats) {
    const std::string file = scene("");
    const Ended first = render(file, "first");
    EXPECT_EQ(first.code, 0) << first.output;
    EXPECT_TRUE(holds(first.output, "the first of 2 sensors is used")) << first.output;
    const Ended side = render(file, "side", "--sensor side");
    EXPECT_EQ(side.code, 0) << side.output;
    EXPECT_FALSE(holds(side.output, "sensors is used")) << side.output;
    EXPECT_NE(hash("first"), hash("side"));
    EXPECT_EQ(render(file, "number", "--sensor 1").code, 0);
    EXPECT_EQ(hash("number"), hash("side"));
    EXPECT_EQ(render((folder_ / "side" / "job.toml").string(), "again").code, 0);
    EXPECT_EQ(hash("again"), hash("side")) << "job.toml names the sensor";
    EXPECT_EQ(render(scene("", "old.xml", "0.6.0"), "last").code, 0);
    EXPECT_EQ(hash("last"), hash("side"));
    const Ended none = render(file, "none", "--sensor top");
    EXPECT_EQ(none.code, 2);
    EXPECT_TRUE(holds(none.output, "no sensor \"top\"") && holds(none.output, "1 (\"side\")")) << none.output;
    EXPECT_EQ(run_treefarm("plan '" + file + "' --sensor side").code, 0);
    EXPECT_EQ(run_treefarm("plan '" + file + "' --sensor 2").code, 2);
    const Ended checked = run_treefarm("check '" + file + "'");
    EXPECT_EQ(checked.code, 0) << checked.output;
    EXPECT_TRUE(holds(checked.output, "note: the first of 2 sensors")) << checked.output;
    EXPECT_EQ(run_treefarm("check '" + file + "' --sensor 7").code, 2);
}

TEST_F(SensorCommand, RendersACropWindow) {
    const std::string plain = " --set guiding.type=none";
    EXPECT_EQ(render(scene(""), "whole", plain).code, 0);
    const Ended cropped = render(scene(kCrop, "crop.xml"), "crop", plain);
    EXPECT_EQ(cropped.code, 0) << cropped.output;
    EXPECT_TRUE(holds(cropped.output, "11 x 7 at 9,3 of 24 x 16")) << cropped.output;
    const auto whole_file = folder_ / "whole" / "image.exr", crop_file = folder_ / "crop" / "image.exr";
    {
        const Imf::InputFile file(crop_file.c_str());
        EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {23, 15}));
        EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({9, 3}, {19, 9}));
    }
    const Image whole = read_exr(whole_file).image, crop = read_exr(crop_file).image;
    for (const std::string& name : whole.channel_names) {
        const auto of_whole = whole.channel(*whole.find(name)), of_crop = crop.channel(*crop.find(name));
        for (std::size_t y = 0; y < 7; ++y)
            for (std::size_t x = 0; x < 11; ++x)
                ASSERT_EQ(of_crop[y * 11 + x], of_whole[(y + 3) * 24 + x + 9]) << name << " " << x << ", " << y;
    }
    const Ended same = run_treefarm("compare '" + crop_file.string() + "' '" + whole_file.string() + "' --json");
    ASSERT_EQ(same.code, 0) << same.output;
    EXPECT_EQ(nlohmann::json::parse(same.output).at("width"), 11);
    EXPECT_TRUE(holds(same.output, "\"rmse\": 0.0")) << same.output;
    EXPECT_EQ(render(scene(kCrop, "crop.xml"), "guided").code, 0);
    const Ended plan = run_treefarm("plan '" + scene(kCrop, "crop.xml") + "' --spp 8 --probe 0.2");
    EXPECT_EQ(plan.code, 0) << plan.output;
    EXPECT_TRUE(holds(plan.output, "11 x 7 pixels")) << plan.output;
}

TEST_F(SensorCommand, RendersFiltersWithNegativeLobes) {
    const std::string file = scene("<rfilter type=\"lanczos\"/>");
    const Ended done = render(file, "lobes");
    EXPECT_EQ(done.code, 0) << done.output;
    const Image image = read_exr(folder_ / "lobes" / "image.exr").image;
    const auto red = image.channel(*image.find("R"));
    EXPECT_TRUE(std::any_of(red.begin(), red.end(), [](float v) { return v < 0; })) << "few samples in negative lobes";
    EXPECT_TRUE(
        holds(run_treefarm("plan -v '" + file + "'").output, "negative lobes multiply the squares of samples by"));
}

/// The camera and the lamp are inside a cube whose walls face outwards.
TEST_F(SensorCommand, SaysWhyAnImageIsBlack) {
    const std::string file =
        write("black.xml",
              "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"><float name=\"fov\" value=\"80\"/><transform "
              "name=\"to_world\"><lookat origin=\"0,0,0.9\" target=\"0,0,0\" up=\"0,1,0\"/></transform><film "
              "type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" "
              "value=\"8\"/></film></sensor>\n"
              "<shape type=\"cube\"><bsdf type=\"diffuse\"/></shape>\n"
              "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0.5\" z=\"0\"/></emitter></scene>")
            .string();
    const Ended black = render(file, "black");
    EXPECT_EQ(black.code, 0) << black.output;
    const Ended checked = run_treefarm("check '" + file + "'"), planned = run_treefarm("plan '" + file + "'");
    EXPECT_EQ(checked.code, 5);
    EXPECT_TRUE(holds(checked.output, "black.xml:3:1: warning: the camera sees only backs")) << checked.output;
    EXPECT_TRUE(holds(checked.output, "black.xml:4:1: warning: all light of this emitter meets")) << checked.output;
    for (const std::string& output : {black.output, planned.output}) {
        EXPECT_TRUE(holds(output, "black.xml:3:1: the camera sees only backs")) << output;
        EXPECT_TRUE(holds(output, "black.xml:4:1: all light of this emitter meets backs")) << output;
        EXPECT_FALSE(holds(output, "warning: warning:") || holds(output, "1: warning:")) << output;
    }
    EXPECT_TRUE(holds(black.output, "the image is black after 7 spp")) << black.output;
    EXPECT_FALSE(holds(render(scene(""), "lit").output, "black"));
}

}  // namespace
}  // namespace treefarm
