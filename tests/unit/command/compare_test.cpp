// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/random.h"
#include "common/image/exr.h"
#include "tests/support/command.h"
#include "tests/support/read_ldr.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

test::Ended compare(const std::string& arguments) {
    return test::run_treefarm("compare " + arguments);
}

nlohmann::json compare_json(const std::string& arguments) {
    const test::Ended outcome = compare(arguments + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    return nlohmann::json::parse(outcome.output);
}

/// Images of 64 x 64 pixels: 1 in every channel, noise of standard deviation 0.1, its variance, 100 spp.
class Compare : public test::FolderTest {
  protected:
    static float uniform_noise(std::uint64_t seed, std::size_t pixel, int channel) {
        const Draw d =
            draw({seed, static_cast<std::uint32_t>(pixel), 0}, static_cast<std::uint32_t>(channel), Stream::camera);
        return (to_unit(d[0]) - 0.5f) * std::sqrt(12.0f) * 0.1f;
    }

    std::string write(const std::string& name, float mean, std::uint64_t seed, bool with_variance, bool half = false) {
        RgbImage colour(64, 64, Rgb(mean));
        if (seed > 0)
            for (std::size_t i = 0; i < colour.pixels.size(); ++i)
                for (int c = 0; c < 3; ++c)
                    colour.pixels[i][c] += uniform_noise(seed, i, c);
        Image image;
        add_rgb_layer(image, "", colour);
        if (with_variance) add_rgb_layer(image, "variance", RgbImage(64, 64, Rgb(0.01f)));
        write_exr(path(name), image, {{"treefarm.spp", "100"}}, half ? PixelType::half : PixelType::float32);
        return path(name);
    }
};

TEST_F(Compare, AnUnbiasedImagePassesAndABiasedOneFails) {
    const std::string reference = write("reference.exr", 1.0f, 0, false, true);
    const auto good = compare_json(write("good.exr", 1.0f, 1, true) + " " + reference);
    EXPECT_NEAR(good["rmse"].get<double>(), 0.1, 0.002);
    EXPECT_NEAR(good["mean_ratio"].get<double>(), 1.0, 0.005);
    EXPECT_EQ(good["image_spp"], 100);
    EXPECT_TRUE(good["z_tests"]["available"].get<bool>());
    EXPECT_TRUE(good["z_tests"]["pixels"]["pass"].get<bool>());
    EXPECT_TRUE(good["z_tests"]["blocks"]["pass"].get<bool>());
    EXPECT_NEAR(good["z_tests"]["pixels"]["mean_z2"].get<double>(), 1.0, 0.05);
    EXPECT_NE(good["z_tests"]["reference_noise"].get<std::string>().find("half"), std::string::npos);
    const auto biased = compare_json(write("biased.exr", 1.05f, 1, true) + " " + reference);
    EXPECT_FALSE(biased["z_tests"]["blocks"]["pass"].get<bool>());
    EXPECT_NEAR(biased["mean_ratio"].get<double>(), 1.05, 0.005);
}

TEST_F(Compare, TheReferencesOwnNoiseIsTakenFromItsSamples) {
    const std::string image = write("image.exr", 1.0f, 1, true), reference = write("reference.exr", 1.0f, 2, false);
    const auto exact = compare_json(image + " " + reference);
    EXPECT_NEAR(exact["z_tests"]["pixels"]["mean_z2"].get<double>(), 2.0, 0.1);
    const auto json = compare_json(image + " " + reference + " --reference-spp 100");
    EXPECT_NEAR(json["z_tests"]["pixels"]["mean_z2"].get<double>(), 1.0, 0.05);
    const std::string known = write("known.exr", 1.0f, 2, true);
    const auto read = compare_json(image + " " + known);
    EXPECT_NEAR(read["z_tests"]["pixels"]["mean_z2"].get<double>(), 1.0, 0.05);
}

TEST_F(Compare, WithoutVarianceItSaysWhyThereIsNoTest) {
    const std::string image = write("image.exr", 1.0f, 1, false), reference = write("reference.exr", 1.0f, 0, false);
    const auto json = compare_json(image + " " + reference);
    EXPECT_FALSE(json["z_tests"]["available"].get<bool>());
    EXPECT_NE(json["z_tests"]["reason"].get<std::string>().find("no variance channels"), std::string::npos);
    const test::Ended table = compare(image + " " + reference);
    EXPECT_EQ(table.code, 0);
    EXPECT_NE(table.output.find("not available"), std::string::npos) << table.output;
    const test::Ended refused = compare(image + " " + reference + " --reference-spp 100");
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.output.find("image.exr: --reference-spp needs"), std::string::npos) << refused.output;
}

TEST_F(Compare, TheTableNamesEveryFigure) {
    const std::string image = write("image.exr", 1.0f, 1, true), reference = write("reference.exr", 1.0f, 0, false);
    const test::Ended table = compare(image + " " + reference);
    EXPECT_EQ(table.code, 0);
    for (const char* word : {"RMSE", "relMSE", "relMSE trimmed", "MAPE", "SMAPE", "outliers", "worst pixel", "FLIP",
                             "FLIP weighted median", "FLIP of [0, 1]", "mean ratio", "NaN/Inf in image",
                             "z-test of pixels", "z-test of blocks", "counts as exact"})
        EXPECT_NE(table.output.find(word), std::string::npos) << word << " in\n" << table.output;
}

TEST_F(Compare, CountsInvalidPixelsAndWritesNullForWhatIsUndefined) {
    Image image;
    RgbImage colour(8, 8);
    colour.pixels[3] = Rgb(std::numeric_limits<float>::quiet_NaN());
    add_rgb_layer(image, "", colour);
    write_exr(path("nan.exr"), image);
    Image black;
    add_rgb_layer(black, "", RgbImage(8, 8));
    write_exr(path("black.exr"), black);
    const auto json = compare_json(path("nan.exr") + " " + path("black.exr"));
    EXPECT_EQ(json["pixels"]["invalid_image"], 1);
    EXPECT_EQ(json["pixels"]["compared"], 63);
    EXPECT_TRUE(json["mean_ratio"].is_null());
    EXPECT_EQ(json["rmse"], 0.0);
    EXPECT_EQ(json["flip"]["hdr"]["mean"], 0.0);
    compare_json(path("nan.exr") + " " + path("black.exr") + " --error-map " + path("map.exr"));
    EXPECT_TRUE(std::isnan(read_exr(path("map.exr")).image.channel(0)[3]));
}

TEST_F(Compare, OnePixelOrNoneToCompare) {
    const auto write_pixel = [&](const std::string& name, float value) {
        Image image;
        add_rgb_layer(image, "", RgbImage(1, 1, Rgb(value)));
        write_exr(path(name), image);
        return path(name);
    };
    const std::string grey = write_pixel("grey.exr", 0.5f), black = write_pixel("black.exr", 0.0f);
    const auto one = compare_json(grey + " " + black);
    EXPECT_EQ(one["worst_pixel"]["x"], 0);
    EXPECT_NEAR(one["flip"]["hdr"]["mean"].get<double>(), 0.96520, 1e-4) << "a black reference: the image's exposures";
    const std::string nan = write_pixel("nan.exr", std::numeric_limits<float>::quiet_NaN());
    const auto none = compare_json(nan + " " + grey);
    EXPECT_EQ(none["pixels"]["compared"], 0);
    EXPECT_TRUE(none["worst_pixel"].is_null());
    EXPECT_TRUE(none["flip"]["hdr"]["mean"].is_null());
    EXPECT_EQ(compare(nan + " " + grey + " --error-map " + path("map.png")).code, 0);
    EXPECT_EQ(read_ldr(path("map.png"), Encoding::srgb).channel(1)[0], 0.0f) << "magenta";
}

TEST_F(Compare, WritesTheDifference) {
    const std::string image = write("image.exr", 3.0f, 0, false), reference = write("reference.exr", 1.0f, 0, false);
    EXPECT_EQ(compare(image + " " + reference + " --difference " + path("d.png")).code, 0);
    const Image png = read_ldr(path("d.png"), Encoding::srgb);
    EXPECT_EQ(png.width, 64);
    EXPECT_EQ(png.channel(0)[0], 1.0f);
    EXPECT_EQ(png.channel(2)[0], 0.0f);
}

TEST_F(Compare, FlipAndItsMap) {
    const std::string image = write("image.exr", 0.0f, 0, false), reference = write("reference.exr", 1.0f, 0, false);
    const auto json = compare_json(image + " " + reference + " --flip-ppd 30 --error-map " + path("map.exr"));
    const auto& flip = json["flip"];
    EXPECT_EQ(flip["pixels_per_degree"], 30.0);
    EXPECT_NEAR(flip["ldr"]["mean"].get<double>(), 0.96739, 1e-4) << "black against white";
    EXPECT_NEAR(flip["hdr"]["mean"].get<double>(), 0.96520, 1e-4) << "black against what 0.85 shows";
    EXPECT_EQ(flip["hdr"]["exposures"], 2);
    EXPECT_EQ(flip["hdr"]["start_exposure"], flip["hdr"]["stop_exposure"]);
    const ExrImage map = read_exr(path("map.exr"));
    EXPECT_EQ(map.image.channel_names, std::vector<std::string>{"Y"});
    EXPECT_NEAR(map.image.channel(0)[17], flip["hdr"]["max"].get<double>(), 1e-6);
    EXPECT_EQ(compare(image + " " + image + " --error-map " + path("map.png")).code, 0);
    EXPECT_EQ(read_ldr(path("map.png"), Encoding::srgb).channel(1)[0], 0.0f) << "no error is black";
}

TEST_F(Compare, NegativeRadianceIsCountedAndShown) {
    const std::string image = write("image.exr", -1.0f, 0, false), reference = write("reference.exr", 0.0f, 0, false);
    EXPECT_EQ(compare_json(image + " " + reference)["pixels"]["negative_image"], 64 * 64);
    EXPECT_NE(compare(image + " " + reference).output.find("negative in image       4096"), std::string::npos);
    EXPECT_NE(compare(reference + " " + image).output.find("negative in reference   4096"), std::string::npos);
}

TEST_F(Compare, BadInputIsOneLineAndExitCodeTwo) {
    const std::string image = write("image.exr", 1.0f, 0, false);
    const test::Ended missing = compare(image + " " + path("missing.exr"));
    EXPECT_EQ(missing.code, 2);
    EXPECT_NE(missing.output.find("missing.exr: no such file"), std::string::npos) << missing.output;
    Image small;
    add_rgb_layer(small, "", RgbImage(2, 2));
    write_exr(path("small.exr"), small);
    const test::Ended sizes = compare(path("small.exr") + " " + image);
    EXPECT_EQ(sizes.code, 2);
    EXPECT_NE(sizes.output.find("2 x 2"), std::string::npos) << sizes.output;
    EXPECT_EQ(std::count(sizes.output.begin(), sizes.output.end(), '\n'), 1) << sizes.output;
    EXPECT_EQ(compare(image).code, 2);
    EXPECT_NE(sizes.output.find("64 x 64"), std::string::npos) << sizes.output;
    EXPECT_EQ(compare(image + " " + image + " --block 0").code, 2);
    for (const char* ppd : {"0", "nan", "1001", "-67"})
        EXPECT_EQ(compare(image + " " + image + " --flip-ppd " + ppd).code, 2) << ppd;
    const test::Ended map = compare(image + " " + image + " --error-map " + path("map.jpg"));
    EXPECT_EQ(map.code, 2);
    EXPECT_NE(map.output.find("map.jpg: --error-map writes PNG and EXR"), std::string::npos) << map.output;
    EXPECT_EQ(compare(image + " " + image + " --error-map " + path("no/map.png")).code, 1);
    EXPECT_EQ(compare(image + " " + image + " --unknown").code, 2);
    EXPECT_EQ(compare(image + " " + image + " --reference-error nan").code, 2);
    EXPECT_EQ(compare(image + " " + image + " > /dev/full").code, 1);
}

}  // namespace
}  // namespace treefarm
