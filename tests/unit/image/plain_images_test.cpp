// SPDX-License-Identifier: Apache-2.0
// BMP, TGA, PPM and PFM; layers of OpenEXR; what is wrong with the others.
#include "tests/support/plain_images.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/image/exr.h"
#include "coordinator/input/images/color_channels.h"
#include "coordinator/input/images/hdr.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

class PlainImages : public ::testing::Test {
  protected:
    static StoredImage read(const std::string& bytes, const char* extension = "") {
        const std::filesystem::path path = test::test_folder() / (std::string("image") + extension);
        std::ofstream(path, std::ios::binary) << bytes;
        return read_stored_image(path);
    }
    static std::string refusal(const std::string& bytes, const char* extension = "") {
        return test::refusal_of([&] { read(bytes, extension); });
    }
    static void expect_pixels(const StoredImage& image) {
        EXPECT_EQ(image.width, 2);
        EXPECT_EQ(image.height, 2);
        EXPECT_TRUE(image.integers);
        EXPECT_EQ(image.bytes, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    }
};

TEST_F(PlainImages, Pixels) {
    expect_pixels(read(test::tiny_bmp()));
    expect_pixels(read(test::tiny_tga(false)));
    expect_pixels(read(test::tiny_tga(true)));
    const std::string with_name = test::tiny_tga(false).substr(0, 18 + 12);
    expect_pixels(read(with_name, ".TGA"));
    expect_pixels(read(test::tiny_ppm()));
    EXPECT_EQ(read("P5 2 1 15\n" + std::string("\x0f\x05", 2)).bytes, (std::vector<std::uint8_t>{255, 85}));
    EXPECT_EQ(read("P5 1 1 65535\n" + std::string("\xff\xff", 2)).floats, std::vector<float>{1.0f});
    const StoredImage pfm = read(test::tiny_pfm());
    EXPECT_EQ(pfm.floats, (std::vector<float>{3.0f, 4.0f, 5.0f, 0.5f, 1.0f, 2.0f})) << "rows from the top, times 1";
    EXPECT_FALSE(pfm.integers);
    EXPECT_EQ(pfm.channels, (std::vector<std::string>{"R", "G", "B"}));
}

TEST_F(PlainImages, CutShort) {
    // The padding of a BMP's last row may be missing.
    for (const std::string& bytes : {test::tiny_bmp().substr(0, 68), test::tiny_ppm(), test::tiny_pfm()})
        for (std::size_t size = 3; size < bytes.size(); ++size)
            EXPECT_NE(refusal(bytes.substr(0, size)), "") << size;
    for (const bool packed : {false, true}) {
        const std::string whole = test::tiny_tga(packed);
        for (std::size_t size = 0; size + 26 < whole.size(); ++size)
            EXPECT_NE(refusal(whole.substr(0, size), ".tga"), "") << size;
    }
}

TEST_F(PlainImages, SizesThatTheBytesCannotHold) {
    std::string bmp = test::tiny_bmp();
    bmp.replace(18, 8, std::string("\xff\xff\0\0\xff\xff\0\0", 8));
    EXPECT_NE(refusal(bmp).find("cut short"), std::string::npos);
    std::string tga = test::tiny_tga(true);
    tga.replace(12, 4, "\xff\xff\xff\xff");
    EXPECT_NE(refusal(tga).find("cut short"), std::string::npos);
    EXPECT_NE(refusal("P6 2000000000 2000000000 255\nabc").find("cut short"), std::string::npos);
    EXPECT_NE(refusal("PF 2000000000 2000000000 -1\nabc").find("cut short"), std::string::npos);
    EXPECT_NE(refusal("P6 -1 1 255\nabc").find("malformed"), std::string::npos);
    EXPECT_NE(refusal("PF 1 1 0\nabcdefghijkl").find("malformed"), std::string::npos);
    EXPECT_NE(refusal("P3 1 1 255\n1 2 3\n").find("only P5 and P6"), std::string::npos);
}

TEST_F(PlainImages, OldRunsOfHdr) {
    const std::string begin = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 16\n";
    const std::string packed = begin + std::string("\x80\x40\x20\x80\x01\x01\x01\x0f", 8);
    EXPECT_NE(refusal(packed).find(kOldHdrRuns), std::string::npos) << refusal(packed);
    EXPECT_EQ(refusal(packed).find("damaged"), std::string::npos) << "it is not";
    EXPECT_NE(refusal(begin + "abcd").find("cut short"), std::string::npos);
}

TEST_F(PlainImages, ColoursOfOneLayer) {
    using Names = std::vector<std::string>;
    const auto chosen = [](const Names& names) { return choose_color_channels("x.exr", names); };
    EXPECT_EQ(chosen({"A", "B", "G", "R", "Z", "diffuse.B", "diffuse.G", "diffuse.R"}), (Names{"R", "G", "B", "A"}));
    EXPECT_EQ(chosen({".B", ".G", ".R"}), (Names{".R", ".G", ".B"}));
    EXPECT_EQ(chosen({"View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R", "View.Depth.Z"}),
              (Names{"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Combined.A"}));
    EXPECT_EQ(chosen({"blue", "green", "red"}), (Names{"red", "green", "blue"}));
    EXPECT_EQ(chosen({"depth.Y"}), Names{"depth.Y"});
    const auto message = [&](const Names& names) { return test::refusal_of([&] { chosen(names); }); };
    EXPECT_NE(message({"a.B", "a.G", "a.R", "b.B", "b.G", "b.R"}).find("several layers: a, b"), std::string::npos);
    EXPECT_NE(message({"U", "V"}).find("but U, V"), std::string::npos);
    const std::filesystem::path path = test::test_folder() / "layer.exr";
    Image image{1, 1, {}, {}};
    add_rgb_layer(image, "beauty", RgbImage(1, 1, Rgb(1, 2, 3)));
    write_exr(path, image);
    EXPECT_EQ(read_stored_image(path).floats, (std::vector<float>{1, 2, 3}));
}

}  // namespace
}  // namespace treefarm
