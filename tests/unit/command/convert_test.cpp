// SPDX-License-Identifier: Apache-2.0
// treefarm convert: pictures and files of an image's layers; the tone maps by their formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "cli/picture_of_layer.h"
#include "cli/tonemap.h"
#include "common/image/exr.h"
#include "common/image/png.h"
#include "common/image/srgb.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/support/command.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

TEST(ToneMap, FollowsItsFormula) {
    const Rgb grey(0.5f), red(4.0f, 0.0f, 0.0f);
    EXPECT_EQ(tone_mapped(ToneMap::srgb, grey), grey);
    EXPECT_EQ(tone_mapped(ToneMap::srgb, red), Rgb(1.0f, 0.0f, 0.0f));
    const float aces = 0.5f * (2.51f * 0.5f + 0.03f) / (0.5f * (2.43f * 0.5f + 0.59f) + 0.14f);
    EXPECT_NEAR(tone_mapped(ToneMap::aces, grey).x, aces, 1e-6f);
    EXPECT_EQ(tone_mapped(ToneMap::aces, Rgb(1e9f)).y, 1.0f);
    EXPECT_NEAR(tone_mapped(ToneMap::reinhard, grey).x, 0.5f / 1.5f, 1e-6f);
    EXPECT_NEAR(tone_mapped(ToneMap::reinhard, Rgb(3.0f)).z, 0.75f, 1e-6f);
    const Rgb mapped = tone_mapped(ToneMap::reinhard, red);
    EXPECT_EQ(mapped.y, 0.0f) << "colours are kept";
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const ToneMap map : {ToneMap::srgb, ToneMap::aces, ToneMap::reinhard}) {
        EXPECT_NEAR(tone_mapped(map, Rgb(kInfinity)).x, 1.0f, 1e-5f);
        EXPECT_EQ(tone_mapped(map, Rgb(-1.0f, std::nanf(""), 0.0f)), Rgb(0.0f));
        float before = -1.0f;
        for (float v = 0.0f; v < 20.0f; v += 0.1f) {
            const float shown = tone_mapped(map, Rgb(v)).x;
            EXPECT_GE(shown, before) << v;
            before = shown;
        }
    }
}

/// Two pixels by one: colour, a normal and nothing, depth 2 and 6, number 3, half opaque.
class Convert : public test::FolderTest {
  protected:
    void SetUp() override {
        image_ = Image{2, 1, {}, {}};
        add("R", 0.25f, 8.0f);
        add("G", 0.25f, 0.0f);
        add("B", 0.25f, 0.0f);
        add("A", 1.0f, 0.5f);
        add("normal.X", 0.0f, 0.0f);
        add("normal.Y", -1.0f, 0.0f);
        add("normal.Z", 0.0f, 0.0f);
        add("depth.Z", 2.0f, 6.0f);
        add("shape.I", 3.0f, 0.0f);
        add("dd.y.Z", 1.0f, 1.0f);
        write_exr(path("in.exr"), image_);
    }

    void add(const char* name, float a, float b) {
        const auto values = image_.add_channel(name);
        values[0] = a;
        values[1] = b;
    }

    test::Ended convert(const std::string& rest) const {
        return test::run_treefarm("convert " + path("in.exr") + " " + rest);
    }

    /// Bytes of the PNG that these options make.
    std::vector<int> picture(const std::string& options) const {
        const test::Ended ended = convert(path("out.png") + " " + options);
        EXPECT_EQ(ended.code, 0) << ended.output;
        const StoredImage png = read_stored_image(path("out.png"));
        return {png.bytes.begin(), png.bytes.end()};
    }

    Image image_;
};

TEST_F(Convert, ColoursGoThroughExposureAndToneMap) {
    EXPECT_EQ(picture(""), (std::vector<int>{137, 137, 137, 255, 255, 0, 0, 128}));  // sRGB of 0.25; alpha as stored
    EXPECT_EQ(picture("--exposure 1")[0], 188);                                      // of 0.5
    EXPECT_EQ(picture("--exposure -3")[3], 255);
    EXPECT_EQ(picture("--tonemap reinhard")[0], 124);  // of 0.2
    EXPECT_GT(picture("--tonemap aces")[0], 137);
}

TEST_F(Convert, OtherLayersAreShownSoThatTheyCanBeSeen) {
    EXPECT_EQ(picture("--layer normal"), (std::vector<int>{128, 0, 128, 0, 0, 0}));
    const std::vector<int> depth = picture("--layer depth");
    EXPECT_EQ(depth[3], 255);
    EXPECT_GT(depth[0], 0);
    EXPECT_LT(depth[0], 64);
    EXPECT_EQ(picture("--layer alpha"), (std::vector<int>{255, 255, 255, 128, 128, 128}));
    const std::vector<int> shape = picture("--layer shape");
    EXPECT_GT(shape[0] + shape[1] + shape[2], 100);
    EXPECT_EQ(shape[3] + shape[4] + shape[5], 0);
    const test::Ended ended = convert(path("out.png") + " --layer depth");
    EXPECT_NE(ended.output.find("depth.Z: 2 is dark, 6 white"), std::string::npos) << ended.output;
    EXPECT_EQ(convert(path("out.png") + " --layer dd.y").code, 0);
}

TEST_F(Convert, ColoursKeepTheirAlpha) {
    ASSERT_EQ(convert(path("out.exr")).code, 0);
    const Image kept = read_exr(path("out.exr")).image;
    ASSERT_EQ(alpha_of(kept).size(), 2u);
    EXPECT_EQ(alpha_of(kept)[1], 0.5f);
    EXPECT_EQ(rgb_layer(kept)->pixels[1].x, 8.0f) << "premultiplied";
    ASSERT_EQ(convert(path("out.png") + " --exposure -5").code, 0);
    const StoredImage png = read_stored_image(path("out.png"));
    ASSERT_EQ(png.channels.size(), 4u);
    EXPECT_EQ(png.bytes[3], 255);
    EXPECT_EQ(png.bytes[7], 128);
    EXPECT_EQ(png.bytes[4], static_cast<int>(255 * srgb_encode(0.5f) + 0.5f)) << "straight: 8 / 32 over 0.5";
    ASSERT_EQ(convert(path("normal.png") + " --layer normal").code, 0);
    EXPECT_EQ(read_stored_image(path("normal.png")).channels.size(), 3u);
}

TEST_F(Convert, ALayerBecomesAFileOfItsOwn) {
    ASSERT_EQ(convert(path("normal.exr") + " --layer normal").code, 0);
    const ExrImage normal = read_exr(path("normal.exr"));
    EXPECT_EQ(normal.image.channel_names, (std::vector<std::string>{"X", "Y", "Z"}));
    EXPECT_EQ(normal.image.channel(1)[0], -1.0f);
    ASSERT_EQ(convert(path("out.pfm") + " --exposure 2").code, 0);
    const StoredImage pfm = read_stored_image(path("out.pfm"));
    EXPECT_EQ(pfm.floats, (std::vector<float>{1, 1, 1, 32, 0, 0}));
}

TEST_F(Convert, SaysWhatIsWrong) {
    const auto refused = [&](const std::string& arguments, const std::string& why) {
        const test::Ended ended = convert(arguments);
        EXPECT_EQ(ended.code, 2) << ended.output;
        EXPECT_NE(ended.output.find(why), std::string::npos) << ended.output;
    };
    refused(path("out.jpg"), ".png, .exr or .pfm");
    refused(path("in.exr"), "is the image that is read");
    refused(path("out.png") + " --layer nromal", "there are: the image itself, dd.y, depth, normal, shape");
    refused(path("out.png") + " --tonemap filmic", "use srgb, aces or reinhard");
    refused(path("out.exr") + " --tonemap aces", "holds radiance");
    refused(path("out.png") + " --layer depth --exposure 1", "is no colour");
    refused(path("out.png") + " --exposure loud", "--exposure");
    EXPECT_EQ(test::run_treefarm("convert " + path("none.exr") + " " + path("out.png")).code, 2);
}

}  // namespace
}  // namespace treefarm
