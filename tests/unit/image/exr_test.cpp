// SPDX-License-Identifier: Apache-2.0
#include "common/image/exr.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/read_bytes.h"
#include "common/base/regular_file.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

fs::path fresh(const std::string& name) {
    const fs::path folder = test::test_folder();
    fs::remove(folder / name);
    return folder / name;
}

Image sample_image() {
    Image image{5, 3, {}, {}};
    float value = 0.1f;
    for (const char* name : {"R", "G", "B", "variance.R", "albedo.G"})
        for (float& v : image.add_channel(name))
            v = (value *= 1.37f);
    return image;
}

/// The message of the InputError that reading throws; empty if it throws none.
std::string refusal(const fs::path& path) {
    return test::refusal_of([&] { read_exr(path); });
}

TEST(Exr, KeepsFloatsNamesAndAttributes) {
    const fs::path path = fresh("a.exr");
    Image image = sample_image();
    image.channel(0)[3] = std::numeric_limits<float>::quiet_NaN();
    image.channel(1)[4] = std::numeric_limits<float>::infinity();
    write_exr(path, image, {{"treefarm.spp", "64"}, {"treefarm.scene", "cornell box"}});
    const ExrImage back = read_exr(path);
    EXPECT_EQ(back.image.width, 5);
    EXPECT_EQ(back.image.height, 3);
    EXPECT_EQ(back.image.channel_names.size(), 5u);
    EXPECT_EQ(back.attributes, (Attributes{{"treefarm.spp", "64"}, {"treefarm.scene", "cornell box"}}));
    for (std::size_t c = 0; c < image.channel_names.size(); ++c) {
        const auto at = back.image.find(image.channel_names[c]);
        ASSERT_TRUE(at) << image.channel_names[c];
        EXPECT_EQ(back.types[*at], PixelType::float32);
        const auto expected = std::as_const(image).channel(c), got = back.image.channel(*at);
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_TRUE(expected[i] == got[i] || (std::isnan(expected[i]) && std::isnan(got[i])))
                << image.channel_names[c] << " pixel " << i;
    }
}

TEST(Exr, HalfRoundsAndClampsInsteadOfOverflowing) {
    const fs::path path = fresh("half.exr");
    Image image{3, 1, {}, {}};
    const auto y = image.add_channel("Y");
    y[0] = 0.1f;
    y[1] = 1e6f;
    y[2] = -1e6f;
    write_exr(path, image, {}, PixelType::half);
    const ExrRgb back = read_exr_rgb(path);
    EXPECT_TRUE(back.half);
    EXPECT_NEAR(back.image.pixels[0].x, 0.1f, 0.1f * 0x1p-11f);
    EXPECT_NE(back.image.pixels[0].x, 0.1f);
    EXPECT_EQ(back.image.pixels[0].x, back.image.pixels[0].z) << "Y is grey";
    EXPECT_EQ(back.image.pixels[1].x, 65504.0f);
    EXPECT_EQ(back.image.pixels[2].x, -65504.0f);
}

TEST(Exr, ReadsIntegers) {
    const fs::path path = fresh("uint.exr");
    Image image{2, 1, {}, {}};
    const auto n = image.add_channel("n");
    n[0] = 3.0f;
    n[1] = -1.0f;
    write_exr(path, image, {}, PixelType::uint32);
    const ExrImage back = read_exr(path);
    EXPECT_EQ(back.types[0], PixelType::uint32);
    EXPECT_EQ(back.image.data, (std::vector<float>{3.0f, 0.0f}));
}

TEST(Exr, ReadsASubsetOfTheChannels) {
    const fs::path path = fresh("a.exr");
    write_exr(path, sample_image());
    const ExrImage back = read_exr(path, [](const std::string& name) { return name.starts_with("variance."); });
    EXPECT_EQ(back.image.channel_names, std::vector<std::string>{"variance.R"});
    EXPECT_EQ(back.image.data.size(), 15u);
    EXPECT_THROW(read_exr(path, [](const std::string&) { return false; }), InputError);
    EXPECT_THROW(read_exr_rgb(path, "normal"), InputError);
}

TEST(Exr, ReadsAnyDataWindow) {
    const fs::path path = fresh("window.exr");
    const Imath::Box2i window({-2, 5}, {1, 6});
    const std::vector<float> values = {1, 2, 3, 4, 5, 6, 7, 8};
    {
        Imf::Header header(Imath::Box2i({0, 0}, {9, 9}), window);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    const ExrImage back = read_exr(path);
    EXPECT_EQ(back.image.width, 4);
    EXPECT_EQ(back.image.height, 2);
    EXPECT_EQ(back.image.data, values);
}

TEST(Exr, RefusesSubsampledChannels) {
    const fs::path path = fresh("sub.exr");
    {
        const std::vector<float> values(4, 1.0f);
        Imf::Header header(4, 4);
        header.channels().insert("BY", Imf::Channel(Imf::FLOAT, 2, 2));
        Imf::FrameBuffer buffer;
        buffer.insert("BY", Imf::Slice::Make(Imf::FLOAT, values.data(), Imath::V2i(0, 0), 2, 2, sizeof(float),
                                             2 * sizeof(float), 2, 2));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(4);
    }
    EXPECT_NE(refusal(path).find("subsampled"), std::string::npos) << refusal(path);
}

TEST(Exr, RefusesWhatIsNoImageAndNamesTheFile) {
    const fs::path missing = fresh("missing.exr");
    EXPECT_NE(refusal(missing).find("missing.exr: no such file"), std::string::npos) << refusal(missing);
    EXPECT_NE(refusal(missing.parent_path()).find("not a regular file"), std::string::npos);
    const fs::path text = fresh("text.exr");
    test::write_file(text, "this is text");
    EXPECT_NE(refusal(text).find("text.exr: not an OpenEXR file"), std::string::npos) << refusal(text);
    test::write_file(text, "");
    EXPECT_NE(refusal(text).find("not an OpenEXR file"), std::string::npos) << refusal(text);
}

TEST(Exr, RefusesEveryTruncation) {
    const fs::path path = fresh("a.exr"), cut = fresh("cut.exr");
    write_exr(path, sample_image());
    const std::string bytes = test::read_file(path);
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
        test::write_file(cut, bytes.substr(0, size));
        EXPECT_NE(refusal(cut).find("cut.exr"), std::string::npos) << "cut to " << size << " of " << bytes.size();
    }
}

TEST(Exr, SurvivesEveryCorruptByte) {
    const fs::path path = fresh("a.exr"), bad = fresh("bad.exr");
    write_exr(path, sample_image());
    const std::string bytes = test::read_file(path);
    int refused = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ 0xff);
        test::write_file(bad, changed);
        try {
            const ExrImage image = read_exr(bad);  // a changed value or name is still an image
            EXPECT_LE(image.image.data.size(), kMaxImageValues);
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 50);
}

TEST(Exr, RefusesAbsurdSizesBeforeAllocating) {
    const fs::path path = fresh("a.exr"), huge = fresh("huge.exr");
    write_exr(path, sample_image());
    std::string bytes = test::read_file(path);
    const std::size_t at = bytes.find("dataWindow");
    ASSERT_NE(at, std::string::npos);
    const std::size_t box = at + std::string("dataWindow").size() + 1 + std::string("box2i").size() + 1 + 4;
    for (const std::int32_t side : {0x3fffffff, 0x7fffffff, 100000, 60000}) {
        std::string changed = bytes;
        for (const std::size_t offset : {std::size_t{8}, std::size_t{12}})
            for (std::size_t i = 0; i < 4; ++i)
                changed[box + offset + i] = static_cast<char>(static_cast<std::uint32_t>(side) >> (8 * i));
        test::write_file(huge, changed);
        EXPECT_NE(refusal(huge).find("huge.exr"), std::string::npos) << side;
    }
}

TEST(Exr, TheSameImageGivesTheSameBytes) {
    const fs::path a = fresh("a.exr"), b = fresh("b.exr");
    write_exr(a, sample_image(), {{"x", "1"}});
    write_exr(b, sample_image(), {{"x", "1"}});
    EXPECT_EQ(test::read_file(a), test::read_file(b));
}

TEST(Exr, WritingReportsWhatFailed) {
    EXPECT_THROW(write_exr(fresh("x") / "no" / "folder.exr", sample_image()), RunError);
    Image twice = sample_image();
    twice.channel_names[1] = "R";
    EXPECT_THROW(write_exr(fresh("twice.exr"), twice), RunError);
    Image wrong = sample_image();
    wrong.data.pop_back();
    EXPECT_THROW(write_exr(fresh("wrong.exr"), wrong), RunError);
    EXPECT_THROW(write_exr(fresh("empty.exr"), Image{}), RunError);
}

TEST(AtomicFile, ReplacesWholeFilesAndLeavesNothingBehind) {
    const fs::path path = fresh("file.bin");
    const std::vector<std::uint8_t> first(100, 1), second(3, 2);
    write_file_atomically(path, first);
    write_file_atomically(path, second);
    EXPECT_EQ(test::read_file(path), "\x02\x02\x02");
    EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()), 1);
}

TEST(AtomicFile, ReplacesFilesThatNeedNotOutliveThePower) {
    const fs::path path = fresh("status.json");
    for (const char content : {'1', '2'}) {
        const std::vector<std::uint8_t> bytes(10, static_cast<std::uint8_t>(content));
        write_file_atomically(path, bytes, Outlives::process);
        EXPECT_EQ(test::read_file(path), std::string(10, content));
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()), 1);
}

TEST(AtomicFile, AFailureKeepsTheOldFile) {
    const fs::path folder = fresh("folder");
    fs::create_directories(folder);
    EXPECT_THROW(write_file_atomically(folder, {}), RunError);
    EXPECT_TRUE(fs::is_directory(folder));
    fs::remove(folder);
}

TEST(AtomicFile, OfAUserIsWrittenThroughLinksAndToDevices) {
    const fs::path path = fresh("file.bin"), link = fresh("link");
    const std::vector<std::uint8_t> old_bytes{1}, new_bytes{65};
    write_file_atomically(path, old_bytes);
    fs::create_symlink(path, link);
    write_output_file(link, new_bytes);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(test::read_file(path), "A");
    write_output_file("/dev/null", new_bytes);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, OfTheProgramReplacesALinkAndRefusesAPipeOrDevice) {
    const fs::path path = fresh("own.bin"), link = fresh("own-link"), pipe = fresh("own-pipe");
    const std::vector<std::uint8_t> old_bytes{66}, new_bytes{65};
    write_file_atomically(path, old_bytes);
    fs::create_symlink(path, link);
    write_file_atomically(link, new_bytes);
    EXPECT_FALSE(fs::is_symlink(link));
    EXPECT_EQ(test::read_file(link), "A");
    EXPECT_EQ(test::read_file(path), "B") << "what the link led to";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const fs::path& special : {pipe, fs::path("/dev/full")}) {
        EXPECT_THROW(write_file_atomically(special, new_bytes), FileError);
        EXPECT_FALSE(fs::is_regular_file(special));
    }
    EXPECT_EQ(read_text(pipe), "") << "without waiting for a writer";
    EXPECT_FALSE(open_regular(pipe, O_RDONLY));
    EXPECT_FALSE(open_regular("/dev/full", O_WRONLY));
    EXPECT_FALSE(open_regular(path.parent_path(), O_RDONLY));
    EXPECT_TRUE(open_regular(path, O_RDONLY));
}

TEST(Image, LayersRoundTrip) {
    RgbImage rgb(2, 2, Rgb(1.0f, 2.0f, 3.0f));
    rgb.pixels[3] = Rgb(4.0f, 5.0f, 6.0f);
    Image image;
    add_rgb_layer(image, "", rgb);
    add_rgb_layer(image, "variance", RgbImage(2, 2));
    EXPECT_EQ(image.channel_names, (std::vector<std::string>{"R", "G", "B", "variance.R", "variance.G", "variance.B"}));
    EXPECT_EQ(rgb_layer(image)->pixels[3], Rgb(4.0f, 5.0f, 6.0f));
    EXPECT_EQ(rgb_layer(image, "variance")->pixels[3], Rgb(0.0f));
    EXPECT_FALSE(rgb_layer(image, "albedo"));
    EXPECT_THROW(add_rgb_layer(image, "albedo", RgbImage(3, 2)), RunError);
}

TEST(Exr, WindowsLieInTheirWhole) {
    const fs::path path = fresh("window.exr");
    Image image = sample_image();
    for (const PixelType type : {PixelType::float32, PixelType::half}) {
        image.crop = {7, 2, 40, 30};
        write_exr(path, image, {}, type);
        {
            const Imf::InputFile file(path.c_str());
            EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {39, 29}));
            EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({7, 2}, {11, 4}));
        }
        const Image read = read_exr(path).image;
        EXPECT_EQ(read.crop, image.crop);
        EXPECT_EQ(read.width, 5);
        if (type == PixelType::float32) {
            for (const char* name : {"R", "variance.R", "albedo.G"})
                EXPECT_TRUE(std::ranges::equal(read.channel(*read.find(name)), image.channel(*image.find(name))));
        }
        image.crop = {};
        write_exr(path, image, {}, type);
        EXPECT_FALSE(read_exr(path).image.crop.is_window());
    }
}

/// Types channel by channel, in tiles and by every compression: halves round, all else comes back as it was, in its
/// window.
TEST(Exr, StoresChannelsInTheirOwnTypes) {
    Image image = sample_image();
    image.crop = {4, 2, 20, 10};
    for (float& id : image.add_channel("shape.I"))
        id = 70000.0f;
    const std::vector<PixelType> types = {PixelType::half,    PixelType::half,    PixelType::half,
                                          PixelType::float32, PixelType::float32, PixelType::uint32};
    for (const char* name : {"auto", "none", "rle", "zips", "zip", "piz"})
        for (const int tiles : {0, 16}) {
            const fs::path path = fresh(std::string(name) + std::to_string(tiles) + ".exr");
            write_file_atomically(path, encode_exr(path, image, {}, {types, *find_compression(name), tiles}));
            const ExrImage back = read_exr(path);
            EXPECT_EQ(back.image.crop, image.crop);
            for (std::size_t c = 0; c < types.size(); ++c) {
                const std::size_t there = *back.image.find(image.channel_names[c]);
                EXPECT_EQ(back.types[there], types[c]) << image.channel_names[c];
                for (std::size_t p = 0; p < image.pixel_count(); ++p) {
                    const float sent = image.channel(c)[p], got = back.image.channel(there)[p];
                    if (types[c] == PixelType::half) {
                        const float largest = 65504.0f;
                        EXPECT_NEAR(got, std::min(sent, largest), 0x1p-11f * sent);
                    } else {
                        EXPECT_EQ(got, sent);
                    }
                }
            }
            const Imf::InputFile file(path.c_str());
            EXPECT_EQ(file.header().hasTileDescription(), tiles > 0);
            if (std::string(name) == "auto") {
                EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
            }
        }
    EXPECT_FALSE(find_compression("dwaa")) << "loses";
}

}  // namespace
}  // namespace treefarm
