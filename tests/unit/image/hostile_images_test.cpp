// SPDX-License-Identifier: Apache-2.0
// Image files that claim more than they hold: refused before anything is allocated for the claim.
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "coordinator/input/images/hdr.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"
#include "tests/support/tiny_images.h"

namespace treefarm {
namespace {

class HostileImages : public ::testing::Test {
  protected:
    static std::filesystem::path path() { return test::test_folder() / "image"; }
    static StoredImage read(const std::string& bytes) {
        std::ofstream(path(), std::ios::binary) << bytes;
        return read_stored_image(path());
    }
    /// The message of the InputError; empty if the image is read.
    static std::string refusal(const std::string& bytes) {
        return test::refusal_of([&] { read(bytes); });
    }
    static void expect_refused(const std::string& bytes, const char* why) {
        EXPECT_NE(refusal(bytes).find(why), std::string::npos) << refusal(bytes);
    }
};

constexpr char kHdrBegin[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

TEST_F(HostileImages, SizesThatTheBytesCannotHold) {
    std::string png = test::TinyPng{1, 1, 3, 8, {1, 2, 3}, 0.0}.bytes();
    EXPECT_EQ(refusal(png), "");
    png.replace(16, 8, std::string("\0\0\x27\x10\0\0\x27\x10", 8));
    expect_refused(png, "claims 10000 x 10000 pixels, which its");
    png.replace(16, 8, std::string("\0\0\xff\xff\0\0\xff\xff", 8));
    expect_refused(png, "claims 65535 x 65535 pixels");

    std::string jpeg = test::tiny_jpeg(8, 8, 1, 50);
    EXPECT_EQ(refusal(jpeg), "");
    jpeg.replace(jpeg.find("\xff\xc0") + 5, 4, std::string("\x27\x10\x27\x10"));
    expect_refused(jpeg, "claims 10000 x 10000 pixels, which its");

    expect_refused(std::string(kHdrBegin) + "-Y 10000 +X 10000\nabcd", "claims 10000 x 10000 pixels, which its");
    expect_refused(std::string(kHdrBegin) + "-Y 2000000000 +X 2000000000\nabcd", "claims 2000000000 x 2000000000");
}

TEST_F(HostileImages, PngChunksBeyondTheEnd) {
    const std::string png = test::TinyPng{2, 2, 1, 8, {1, 2, 3, 4}, 0.0}.bytes();
    std::string changed = png;
    changed[changed.find("IDAT") - 4] = '\x20';  // 512 MiB
    expect_refused(changed, "is cut short");
    for (std::size_t size = 0; size + 4 < png.size(); ++size)
        EXPECT_NE(refusal(png.substr(0, size)), "") << size;
}

TEST_F(HostileImages, JpegWithoutAnEnd) {
    const std::string jpeg = test::tiny_jpeg(40, 30, 3, 80);
    const StoredImage image = read(jpeg);
    EXPECT_EQ(image.width, 40);
    EXPECT_EQ(image.channels.size(), 3u);
    for (std::size_t size = 0; size < jpeg.size(); size += 7)
        EXPECT_NE(refusal(jpeg.substr(0, size)), "") << size << " of " << jpeg.size();
}

TEST_F(HostileImages, JpegTablesThatAreTooLong) {
    const std::string jpeg = test::tiny_jpeg(8, 8, 1, 50);
    const std::size_t tables = jpeg.find("\xff\xc4");
    for (const std::size_t length : {9u, 16u}) {
        std::string changed = jpeg;
        changed.replace(tables + 5, length, length, '\xff');  // so many codes of each length
        expect_refused(changed, "Bogus Huffman table definition");
    }
    // And the size is unreadable: tables are read while the size is looked for.
    std::string sizeless = jpeg;
    sizeless.replace(tables + 5, 16, 16, '\xff');
    sizeless[sizeless.find("\xff\xc0")] = '\0';
    expect_refused(sizeless, "Bogus Huffman table definition");
    // Behind the first scan, where a progressive file has tables too.
    expect_refused(jpeg.substr(0, jpeg.size() - 2) + "\xff\xc4\x7f\xff" + std::string(17, '\xff') + "\xff\xd9",
                   "Bogus Huffman table definition");
    // In a comment they are none.
    const std::string comment = std::string("\xff\xfe\0\x16\xff\xc4", 6) + std::string(18, '\xff');
    EXPECT_EQ(refusal(jpeg.substr(0, 2) + comment + jpeg.substr(2)), "");
}

// A scan that refers to a table that is not there: nothing depends on what memory held before.
TEST_F(HostileImages, JpegWithoutATable) {
    std::string jpeg = test::tiny_jpeg(40, 30, 3, 80);
    const std::size_t scan = jpeg.find("\xff\xda");
    jpeg[scan + 6] = '\x33';
    const std::string first = refusal(jpeg);
    const StoredImage image = first.empty() ? read(jpeg) : StoredImage();
    std::vector<std::vector<char>> dirt;
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 50; ++i)
            dirt.emplace_back(static_cast<std::size_t>(1 + i) * 1000, static_cast<char>(round * 50 + i));
        dirt.clear();
        EXPECT_EQ(refusal(jpeg), first);
        if (first.empty()) {
            EXPECT_EQ(read(jpeg).bytes, image.bytes);
        }
    }
}

// stb's decoder takes the zeros behind a cut line for runs of no length, and never ends.
TEST_F(HostileImages, HdrLinesThatAreCutShort) {
    const std::string line = std::string("\x02\x02\x00\x09", 4) + "\x89\x80" +
                             "\x05vwxyz\x04"
                             "abcd" +
                             "\x89\x10" + "\x89\x81";
    const std::string file = std::string(kHdrBegin) + "-Y 2 +X 9\n" + line + line;
    const StoredImage image = read(file);
    ASSERT_EQ(image.floats.size(), 54u);
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{9}}) {
        EXPECT_EQ(image.floats[3 * pixel], 1.0f) << "128 x 2^(129 - 136)";
        EXPECT_EQ(image.floats[3 * pixel + 1], static_cast<float>('v') / 128.0f);
        EXPECT_EQ(image.floats[3 * (pixel + 8) + 1], static_cast<float>('d') / 128.0f);
        EXPECT_EQ(image.floats[3 * pixel + 2], 0.125f);
    }
    for (std::size_t size = 0; size < file.size(); ++size)
        EXPECT_NE(refusal(file.substr(0, size)), "") << size;
    std::string empty_run = file;
    empty_run[file.find("\x89\x80")] = '\0';
    expect_refused(empty_run, "a run does not fit into its line");
    expect_refused(std::string(kHdrBegin) + "-Y 1 +X 2\nabcdefg", "is cut short");
    expect_refused(std::string(kHdrBegin) + "+Y 1 +X 1\nabcd", "rows do not run");
    expect_refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "not RGBE");
}

TEST_F(HostileImages, ExrHeadersThatClaimTooMuch) {
    Image image{5, 3, {}, {}};
    add_rgb_layer(image, "", RgbImage(5, 3, Rgb(1.0f)));
    write_exr(path(), image, {{"note", "text"}});
    std::ifstream in(path(), std::ios::binary);
    const std::string exr{std::istreambuf_iterator<char>(in), {}};
    in.close();
    ASSERT_EQ(refusal(exr), "");
    const auto changed = [&](const std::string& attribute, std::size_t at, std::uint32_t value) {
        std::string bytes = exr;
        const std::size_t begin = exr.find(attribute) + attribute.size() + at;
        for (std::size_t i = 0; i < 4; ++i)
            bytes[begin + i] = static_cast<char>(value >> (8 * i));
        return bytes;
    };
    const std::string note("note\0string", 12), window("dataWindow\0box2i", 17), box("displayWindow\0box2i", 20);
    for (const std::uint32_t size : {0x7fffffffu, 0xffffffffu, 1u << 28})
        expect_refused(changed(note, 0, size), "its header is damaged");
    // OpenEXR reads 16 bytes of a box whatever its size says, and takes what follows for something else.
    expect_refused(changed(box, 0, 5), "its header is damaged");
    for (const std::size_t axis : {std::size_t{12}, std::size_t{16}})
        expect_refused(changed(window, axis, 60000), "which its");
    expect_refused(changed(window, 12, 70000), "more than 65536 on a side");
    // OpenEXR has the same limit, should our walk over the headers miss one: it then opens no such file.
    try {
        const Imf::InputFile file(path().c_str());
        ADD_FAILURE() << "opened";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("exceeds the maximum width of 65536"), std::string::npos)
            << error.what();
    }
    // A tile's size stands where the file has none: put one in.
    std::string tiled = exr;
    std::string tiles("tiles\0tiledesc\0\x09\0\0\0", 19);
    tiles += std::string("\0\0\x01\0\0\0\x01\0\0", 9);
    tiled.insert(exr.find("dataWindow"), tiles);
    expect_refused(tiled, "claims tiles of 65536 x 65536 pixels");
}

}  // namespace
}  // namespace treefarm
