// SPDX-License-Identifier: Apache-2.0
#include "common/image/png.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>

#include "common/base/error.h"
#include "common/image/srgb.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/support/read_ldr.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

fs::path fresh_png(const std::string& name) {
    const fs::path folder = test::test_folder();
    fs::remove(folder / name);
    return folder / name;
}

std::string png_refusal(const fs::path& path) {
    return test::refusal_of([&] { read_ldr(path, Encoding::srgb); });
}

TEST(Png, SrgbIsItsOwnInverse) {
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255.0f;
        EXPECT_NEAR(srgb_encode(srgb_decode(encoded)), encoded, 1e-6f);
    }
    EXPECT_NEAR(srgb_decode(0.5f), 0.21404114f, 1e-6f);  // ((0.5 + 0.055) / 1.055)^2.4
}

TEST(Png, EveryValueBecomesTheNearestByte) {
    const fs::path path = fresh_png("ramp.png");
    RgbImage image(500, 200);
    const auto count = static_cast<float>(image.pixels.size());
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        const float x = static_cast<float>(p) / count;
        image.pixels[p] = Rgb(x, 0.01f * x, x * x);
    }
    write_png(path, image);
    const Image read = read_ldr(path, Encoding::linear);
    ASSERT_EQ(read.data.size(), 3 * image.pixels.size());
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t p = 0; p < image.pixels.size(); ++p)
            ASSERT_NEAR(255 * read.channel(c)[p], 255 * srgb_encode(image.pixels[p][static_cast<int>(c)]), 0.501)
                << "pixel " << p << ", channel " << c;
}

TEST(Png, WritesSrgbWithExposureAndReadsItBack) {
    const fs::path path = fresh_png("a.png");
    RgbImage image(3, 2);
    image.pixels[0] =
        Rgb(srgb_decode(10.0f / 255.0f), srgb_decode(128.0f / 255.0f), srgb_decode(200.0f / 255.0f)) * 0.5f;
    image.pixels[1] = Rgb(std::numeric_limits<float>::quiet_NaN(), -1.0f, std::numeric_limits<float>::infinity());
    image.pixels[5] = Rgb(0.25f);
    write_png(path, image, 2.0f);
    const Image encoded = read_ldr(path, Encoding::linear);
    EXPECT_EQ(encoded.channel_names, (std::vector<std::string>{"R", "G", "B"}));
    ASSERT_EQ(encoded.width, 3);
    ASSERT_EQ(encoded.height, 2);
    EXPECT_FLOAT_EQ(encoded.channel(0)[0], 10.0f / 255.0f);
    EXPECT_FLOAT_EQ(encoded.channel(1)[0], 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(encoded.channel(2)[0], 200.0f / 255.0f);
    EXPECT_EQ(encoded.channel(0)[1], 0.0f) << "NaN is black";
    EXPECT_EQ(encoded.channel(1)[1], 0.0f) << "negative is black";
    EXPECT_EQ(encoded.channel(2)[1], 1.0f) << "infinite is white";
    EXPECT_FLOAT_EQ(encoded.channel(0)[5], 188.0f / 255.0f) << "0.25 x 2, encoded";
    const Image linear = read_ldr(path, Encoding::srgb);
    EXPECT_NEAR(linear.channel(0)[5], 0.5f, 0.003f);
}

TEST(Png, RefusesWhatIsNoImageAndNamesTheFile) {
    const fs::path path = fresh_png("bad.png");
    EXPECT_NE(png_refusal(path).find("bad.png: no such file"), std::string::npos);
    std::ofstream(path) << "GIF89a and more text";
    EXPECT_NE(png_refusal(path).find("bad.png: is neither PNG nor JPEG"), std::string::npos) << png_refusal(path);
    std::ofstream(path, std::ios::trunc) << "";
    EXPECT_NE(png_refusal(path).find("bad.png"), std::string::npos);
}

TEST(Png, RefusesTruncation) {
    const fs::path path = fresh_png("a.png"), cut = fresh_png("cut.png");
    write_png(path, RgbImage(40, 30, Rgb(0.3f)));
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (std::size_t size = 0; size + 20 < bytes.size(); size += 5) {  // the last 20 bytes hold no pixels
        std::ofstream(cut, std::ios::binary) << bytes.substr(0, size);
        EXPECT_NE(png_refusal(cut).find("cut.png"), std::string::npos) << "cut to " << size << " of " << bytes.size();
    }
}

TEST(Png, WritingReportsWhatFailed) {
    EXPECT_THROW(write_png(fresh_png("no") / "folder" / "a.png", RgbImage(1, 1)), RunError);
    EXPECT_THROW(write_png(fresh_png("empty.png"), RgbImage()), RunError);
}

TEST(Png, AlphaMakesItRgbaWithStraightColours) {
    RgbImage image(3, 1);
    image.pixels = {Rgb(0.25f, 0.125f, 0.0f), Rgb(0.5f), Rgb(0.25f)};
    const std::vector<float> alpha = {0.5f, 1.0f, 0.0f};
    const RgbImage straight = straight_colours(image, alpha);
    EXPECT_EQ(straight.pixels, (std::vector<Rgb>{Rgb(0.5f, 0.25f, 0.0f), Rgb(0.5f), Rgb(0.25f)}))
        << "0 keeps its colour";
    EXPECT_EQ(straight_colours(image, {}).pixels, image.pixels);
    const std::vector<std::uint8_t> png = encode_png(straight, 1.0f, alpha);
    EXPECT_EQ(png[25], 6) << "colour type of RGBA";
    const fs::path path = fresh_png("alpha.png");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    const StoredImage read = read_stored_image(path);
    ASSERT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    const auto byte = [](float linear) { return static_cast<std::uint8_t>(255 * srgb_encode(linear) + 0.5f); };
    EXPECT_EQ(read.bytes, (std::vector<std::uint8_t>{byte(0.5f), byte(0.25f), 0, 128, byte(0.5f), byte(0.5f),
                                                     byte(0.5f), 255, byte(0.25f), byte(0.25f), byte(0.25f), 0}));
}

}  // namespace
}  // namespace treefarm
