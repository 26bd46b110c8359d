// SPDX-License-Identifier: Apache-2.0
// Layers from the scene file or the command line to the file, and what other programs make of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/image/exr.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/support/command.h"
#include "tests/support/source_root.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

using test::kRoot;

class Outputs : public test::FolderTest {
  protected:
    ExrImage render(const std::string& scene, const std::string& options) const {
        const test::Ended ended =
            test::run_treefarm("render '" + scene + "' --quiet --spp 8 --threads 1 --overwrite --run-dir '" +
                               (folder_ / "run").string() + "' " + options);
        EXPECT_EQ(ended.code, 0) << ended.output;
        return read_exr(folder_ / "run/image.exr");
    }

    ExrImage render_box(const std::string& options) const {
        return render((kRoot / "configs/scenes/cornell-box.xml").string(), "-D size=24 " + options);
    }
};

std::span<const float> channel(const ExrImage& file, const std::string& name) {
    const auto at = file.image.find(name);
    EXPECT_TRUE(at) << name;
    return at ? file.image.channel(*at) : std::span<const float>();
}

PixelType type(const ExrImage& file, const std::string& name) {
    return file.types.at(*file.image.find(name));
}

TEST_F(Outputs, LayersAreInTheFileAndTheImageIsTheSame) {
    const ExrImage plain = render_box("");
    EXPECT_EQ(plain.image.channel_names.size(), 12u);
    const ExrImage layered = render_box("--set output.aovs=albedo,near:depth,alpha,material,direct,indirect");
    EXPECT_EQ(layered.image.channel_names.size(), 12u + 3 + 1 + 1 + 1 + 3 + 3);
    EXPECT_EQ(layered.attributes.at("treefarm.image_hash"), plain.attributes.at("treefarm.image_hash"));
    EXPECT_NE(layered.attributes.at("treefarm.job").find("aovs = ["), std::string::npos) << "it can be repeated";
    for (const char* name : {"near.Z", "A", "material.I", "albedo.R"}) {
        const auto values = channel(layered, name);
        EXPECT_GT(*std::max_element(values.begin(), values.end()), 0.0f) << name;
        EXPECT_EQ(type(layered, name), PixelType::float32);
    }
    const auto whole = channel(layered, "G"), direct = channel(layered, "direct.G"),
               rest = channel(layered, "indirect.G");
    for (std::size_t p = 0; p < whole.size(); ++p)
        EXPECT_NEAR(direct[p] + rest[p], whole[p], 1e-6f * whole[p] + 1e-9f);
}

TEST_F(Outputs, HalfIsForWhatIsNoDistanceAndNoNumber) {
    const ExrImage file =
        render_box("--set output.aovs=normal,depth,shape,alpha --set output.half=true --set output.tiles=16");
    for (const char* name : {"R", "halfA.G", "normal.Z", "A"})
        EXPECT_EQ(type(file, name), PixelType::half) << name;
    for (const char* name : {"variance.R", "depth.Z", "shape.I"})
        EXPECT_EQ(type(file, name), PixelType::float32) << name;
}

TEST_F(Outputs, APictureIsWrittenBesideTheImage) {
    const ExrImage file = render_box("-o '" + (folder_ / "x.png").string() + "'");
    const StoredImage picture = read_stored_image(folder_ / "x.png");
    EXPECT_EQ(picture.width, file.image.width);
    const float left = channel(file, "R")[24 * 12 + 2];
    EXPECT_NEAR(picture.bytes[3 * (24 * 12 + 2)],
                255 * (1.055 * std::pow(std::min(1.0, double(left)), 1 / 2.4) - 0.055), 1.0);
    const test::Ended refused =
        test::run_treefarm("render '" + (kRoot / "configs/scenes/cornell-box.xml").string() + "' -o x.jpg");
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.output.find(".exr or .png"), std::string::npos) << refused.output;
}

/// Files of users (shared/cases), as Mitsuba reads them.
class OutputCases : public Outputs {
  protected:
    std::string shared(const std::string& name) const {
        const fs::path file = kRoot / "../shared/cases" / name;
        return fs::exists(file) ? file.string() : "";
    }
};

TEST_F(OutputCases, AovsOfMitsuba) {
    const std::string scene = shared("alpha/aov.xml");
    if (scene.empty()) GTEST_SKIP() << "shared/cases is not here";
    const ExrImage file = render(scene, "");
    // A sphere of radius 1 about the origin, seen from (0, 0, 4).
    const std::size_t middle = 16 * 32 + 16;
    EXPECT_NEAR(channel(file, "dd.y.Z")[middle], 3.0f, 0.01f);
    EXPECT_NEAR(channel(file, "nn.Z")[middle], 1.0f, 0.01f);
    EXPECT_NEAR(channel(file, "alb.G")[middle], 0.5f, 1e-4f);
    EXPECT_EQ(channel(file, "alb.G")[0], 0.0f);
}

TEST_F(OutputCases, AlphaWhereTheEmittersAreHidden) {
    const std::string scene = shared("alpha/rgba.xml");
    if (scene.empty()) GTEST_SKIP() << "shared/cases is not here";
    const ExrImage file = render(scene, "");
    const auto alpha = channel(file, "A"), red = channel(file, "R");
    EXPECT_EQ(alpha[0], 0.0f);
    EXPECT_EQ(red[0], 0.0f);
    EXPECT_EQ(alpha[16 * 32 + 16], 1.0f);
    double sum = 0;  // the sphere's disk: sin = 1/4, so its edge is at tan = 1/sqrt(15) of the film's tan 20 degrees
    for (const float a : alpha)
        sum += static_cast<double>(a);
    const double radius = 1 / std::sqrt(15.0) / std::tan(20 * M_PI / 180) / 2;
    EXPECT_NEAR(sum / (32 * 32), M_PI * radius * radius, 0.01);
}

TEST_F(OutputCases, LayersOfACropWindowLieInIt) {
    const std::string scene = shared("cameras/crop.xml");
    if (scene.empty()) GTEST_SKIP() << "shared/cases is not here";
    const ExrImage file = render(scene, "--set output.aovs=position,alpha --set output.tiles=16");
    EXPECT_TRUE(file.image.crop.is_window());
    EXPECT_EQ(channel(file, "A").size(), file.image.pixel_count());
}

/// What of other people's programs is installed reads the file with all of its layers.
TEST_F(Outputs, OtherProgramsReadThem) {
    render_box("--set output.aovs=albedo,normal,depth,position,uv,shape,alpha --set output.half=true");
    const std::string file = "'" + (folder_ / "run/image.exr").string() + "'";
    bool any = false;
    const auto installed = [](const std::string& program) {
        return test::run_command("command -v " + program).code == 0;
    };
    if (installed("exrheader")) {
        any = true;
        const test::Ended header = test::run_command("exrheader " + file);
        EXPECT_EQ(header.code, 0) << header.output;
        for (const char* name : {"albedo.R", "normal.X", "depth.Z", "shape.I"})
            EXPECT_NE(header.output.find(name), std::string::npos) << header.output;
    }
    if (installed("identify") && test::run_command("identify -list format | grep -qi ' EXR'").code == 0) {
        any = true;
        const test::Ended identified = test::run_command("identify -format '%w %h' " + file);
        EXPECT_EQ(identified.output, "24 24");
    }
    if (installed("blender")) {
        any = true;
        std::ofstream(folder_ / "read.py")
            << "import bpy\nimage = bpy.data.images.load(" << file
            << ")\ntuple(image.size)  # reads it; no size of one with layers\nassert image.type == 'MULTILAYER'\n"
            << "print('layers read')\n";
        const test::Ended read =
            test::run_command("blender --background --python '" + (folder_ / "read.py").string() + "'");
        EXPECT_NE(read.output.find("layers read"), std::string::npos) << read.output;
    }
    if (!any) GTEST_SKIP() << "neither exrheader, ImageMagick with EXR nor Blender is installed";
}

}  // namespace
}  // namespace treefarm
