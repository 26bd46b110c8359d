// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/map_parts.h"
#include "worker/lights/environment_map.h"

namespace treefarm {
namespace {

constexpr double kSkySignificance = 1e-4;

TextureImage black(int width, int height) {
    TextureImage image;
    image.width = width;
    image.height = height;
    image.floats.assign(static_cast<std::size_t>(3 * width * height), 0.0f);
    return image;
}

void set(TextureImage& image, int x, int y, const Rgb& value) {
    for (int c = 0; c < 3; ++c)
        image.floats[static_cast<std::size_t>(3 * (y * image.width + x) + c)] = value[c];
}

EnvironmentEmitter turned() {
    EnvironmentEmitter emitter;
    emitter.x_axis = normalize(Vec3(1, 2, 0.5f));
    emitter.z_axis = normalize(cross(emitter.x_axis, Vec3(0, 1, 0)));
    emitter.y_axis = cross(emitter.z_axis, emitter.x_axis);
    return emitter;
}

/// Direction at (u, v) as the interface defines it, by the C library.
Vec3 direction_at(const EnvironmentEmitter& e, double u, double v) {
    const double x = std::sin(M_PI * v) * std::sin(2 * M_PI * u), z = -std::sin(M_PI * v) * std::cos(2 * M_PI * u);
    return normalize(e.x_axis * static_cast<float>(x) + e.y_axis * static_cast<float>(std::cos(M_PI * v)) +
                     e.z_axis * static_cast<float>(z));
}

Vec2 uv_of(const EnvironmentEmitter& e, const Vec3& d) {
    const double x = double(dot(d, e.x_axis)), y = double(dot(d, e.y_axis)), z = double(dot(d, e.z_axis));
    const double turn = std::atan2(x, -z) / (2 * M_PI);
    return {static_cast<float>(turn < 0 ? turn + 1 : turn), static_cast<float>(std::atan2(std::hypot(x, z), y) / M_PI)};
}

/// Samples against the density over (u, v), where poles are no singularities.
void expect_agreement(const TextureImage& image, const std::string& what, bool rows_at_poles = false,
                      bool learned = false) {
    EnvironmentEmitter emitter = turned();
    emitter.rows_at_poles = rows_at_poles;
    const EnvironmentMap map(emitter, image);
    const test::MapParts parts(map, learned);
    constexpr int kColumns = 64, kRows = 32, kSub = 8, kSamples = 400000;
    std::vector<double> counts(kColumns * kRows), expected(kColumns * kRows);
    double integral = 0;
    for (int i = 0; i < kColumns * kSub; ++i)
        for (int j = 0; j < kRows * kSub; ++j) {
            const double u = (i + 0.5) / (kColumns * kSub), v = (j + 0.5) / (kRows * kSub);
            const double probability = double(map.pdf(direction_at(emitter, u, v), parts.choice)) * 2 * M_PI * M_PI *
                                       std::sin(M_PI * v) / (kColumns * kSub * kRows * kSub);
            expected[static_cast<std::size_t>(j / kSub * kColumns + i / kSub)] += probability * kSamples;
            integral += probability;
        }
    EXPECT_NEAR(integral, 1.0, 2e-3) << what;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3 d = parts.sample(map, draw({7, i, 0}, 1, Stream::light)).direction;
        ASSERT_NEAR(d.length(), 1.0f, 1e-5f);
        const Vec2 uv = uv_of(emitter, d);
        const int x = std::min(static_cast<int>(uv.x * kColumns), kColumns - 1);
        const int y = std::min(static_cast<int>(uv.y * kRows), kRows - 1);
        ++counts[static_cast<std::size_t>(y * kColumns + x)];
    }
    // Cells that samples hardly reach: rounding moves a few across their edges.
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (expected[i] < 1 && counts[i] < 5) counts[i] = expected[i] = 0;
    EXPECT_GT(test::chi_square_test(counts, expected), kSkySignificance) << what;
}

TEST(EnvironmentMap, OneBrightTexelAnywhere) {
    for (const auto& [x, y] : {std::pair{5, 3}, {0, 4}, {15, 4}, {3, 0}, {9, 7}, {0, 0}, {15, 7}})
        for (const float background : {0.0f, 0.01f}) {
            TextureImage image = black(16, 8);
            std::fill(image.floats.begin(), image.floats.end(), background);
            set(image, x, y, Rgb(1.0f, 2.0f, 3.0f));
            expect_agreement(image, std::to_string(x) + ", " + std::to_string(y));
            expect_agreement(image, std::to_string(x) + ", " + std::to_string(y) + " at poles", true);
        }
}

TEST(EnvironmentMap, BrightTexelOfAnyMagnitude) {
    for (const float value : {1e-30f, 1e-3f, 1e10f, 1e30f}) {
        TextureImage image = black(16, 8);
        set(image, 5, 3, Rgb(value));
        expect_agreement(image, std::to_string(value));
    }
}

TEST(EnvironmentMap, RandomTexels) {
    TextureImage image = black(32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const Draw r = draw({1, static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(x)}, 0, Stream::light);
            const float value = to_unit(r[0]);
            if (r[3] % 3 != 0) set(image, x, y, Rgb(value * value * value * 5));
        }
    expect_agreement(image, "random");
    expect_agreement(image, "random at poles", true);
    expect_agreement(image, "random, parts as learned", false, true);
}

TEST(EnvironmentMap, LooksUpWhatTheInterfaceSays) {
    TextureImage image = black(8, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            set(image, x, y, Rgb(static_cast<float>(x), static_cast<float>(y), 1.0f));
    EnvironmentEmitter emitter;
    emitter.scale = 2.0f;
    const EnvironmentMap map(emitter, image);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const Rgb c = map.radiance(direction_at(emitter, (x + 0.5) / 8, (y + 0.5) / 4));
            EXPECT_LT((c - Rgb(2 * static_cast<float>(x), 2 * static_cast<float>(y), 2)).length(), 1e-4f);
        }
    EXPECT_LT((map.radiance(Vec3(0, 1, 0)) - Rgb(7, 0, 2)).length(), 1e-4f) << "at the pole u is 0: the seam";
    EXPECT_NEAR(map.radiance(Vec3(0, 0, -1)).x, 7.0f, 1e-4f) << "halfway between the last column and the first";
    EXPECT_NEAR(map.radiance(Vec3(1, 0, 0)).x, 3.0f, 1e-4f) << "a quarter turn from -z to x";
    EXPECT_NEAR(map.radiance(Vec3(1, 0, 0)).y, 3.0f, 1e-4f) << "the equator";
}

TEST(EnvironmentMap, OuterRowsLieOnThePolesWhereMitsuba3HasThem) {
    TextureImage image = black(8, 5);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 8; ++x)
            set(image, x, y, Rgb(static_cast<float>(x), static_cast<float>(y), 1.0f));
    EnvironmentEmitter emitter;
    emitter.rows_at_poles = true;
    const EnvironmentMap map(emitter, image);
    for (const double v : {0.0, 0.1, 0.25, 0.6, 0.9, 1.0})
        for (int x = 0; x < 8; ++x) {
            const Rgb c = map.radiance(direction_at(emitter, (x + 0.5) / 8, v));
            EXPECT_NEAR(c.y, 4 * v, 1e-5) << v;
            if (v > 0 && v < 1) {
                EXPECT_NEAR(c.x, x, 1e-5) << v;
            }
        }
    TextureImage single = black(8, 1);
    set(single, 3, 0, Rgb(1.0f));
    expect_agreement(single, "a single row", true);
}

TEST(EnvironmentMap, DensityIsPositiveWhereRadianceIs) {
    TextureImage image = black(64, 32);
    set(image, 10, 10, Rgb(1e6f));
    set(image, 30, 20, Rgb(1e-6f, 0, 0));
    set(image, 40, 0, Rgb(0, 0, 1e-3f));
    const EnvironmentEmitter emitter = turned();
    const EnvironmentMap map(emitter, image);
    const test::MapParts parts(map);
    int bright = 0;
    for (std::uint32_t i = 0; i < 300000; ++i) {
        const Draw r = draw({2, i, 0}, 0, Stream::light);
        const Vec3 d = direction_at(emitter, double(to_unit(r[0])), double(to_unit(r[1])));
        if (is_black(map.radiance(d))) continue;
        ++bright;
        ASSERT_GT(map.pdf(d, parts.choice), 0.0f);
        ASSERT_TRUE(std::isfinite(map.pdf(d, parts.choice)));
    }
    EXPECT_GT(bright, 500);
    for (const Vec3& pole : {emitter.y_axis, -emitter.y_axis, Vec3(0, 1, 0)}) {
        EXPECT_TRUE(std::isfinite(map.pdf(pole, parts.choice)));
        EXPECT_TRUE(is_finite(map.radiance(pole)));
    }
}

TEST(EnvironmentMap, BatchesAreTheirSamplesToTheBit) {
    TextureImage image = black(300, 40);
    for (std::uint32_t i = 0; i < image.floats.size(); ++i)
        image.floats[i] = to_unit(draw({3, i, 0}, 0, Stream::light)[0]);
    set(image, 299, 0, Rgb(500.0f));
    set(image, 7, 39, Rgb(500.0f));
    const EnvironmentMap map(turned(), image);
    const test::MapParts parts(map);
    EnvironmentBatch batch;
    std::uint32_t asked = 0;
    for (const std::uint32_t size : {64u, 1u, 0u, 37u}) {
        batch.clear();
        std::vector<EnvironmentMap::Sample> alone;
        for (std::uint32_t i = 0; i < size; ++i) {
            const Draw random = draw({4, asked++, 0}, 0, Stream::light);
            const int part = static_cast<int>(parts.table.pick(random[0]));
            ASSERT_EQ(batch.add(part, random), i);
            alone.push_back(map.sample(part, random));
        }
        map.sample(batch);
        for (std::uint32_t i = 0; i < size; ++i) {
            EXPECT_EQ(batch[i].direction, alone[i].direction) << i << " of " << size;
            EXPECT_EQ(batch[i].sine, alone[i].sine);
            EXPECT_EQ(map.pdf(batch[i], parts.choice), map.pdf(alone[i], parts.choice));
            EXPECT_EQ(map.radiance(batch.footprint(i)), map.radiance(alone[i].footprint));
        }
    }
}

TEST(EnvironmentMap, BadTexelsAreBlack) {
    TextureImage image = black(4, 4);
    const float bad[] = {std::nanf(""), -1.0f, std::numeric_limits<float>::infinity()};
    for (int i = 0; i < 3; ++i)
        set(image, i, 1, Rgb(bad[i]));
    EXPECT_TRUE(EnvironmentMap(turned(), image).black());
    set(image, 3, 3, Rgb(1.0f));
    expect_agreement(image, "bad texels");
}

TEST(EnvironmentMap, LargeImages) {
    // 2^31 shares of rows with 8192 texels: the dim ones must keep theirs.
    TextureImage image = black(8192, 16);
    std::fill(image.floats.begin(), image.floats.end(), 1e-12f);
    set(image, 4000, 7, Rgb(1e6f));
    const EnvironmentEmitter emitter = turned();
    const EnvironmentMap map(emitter, image);
    const test::MapParts parts(map);
    for (int i = 0; i < 1000; ++i)
        ASSERT_GT(map.pdf(direction_at(emitter, (i + 0.5) / 1000, (i % 16 + 0.5) / 16), parts.choice), 0.0f);
    int near = 0;
    for (std::uint32_t i = 0; i < 1000; ++i)
        near += dot(parts.sample(map, draw({7, i, 0}, 1, Stream::light)).direction,
                    direction_at(emitter, 4000.5 / 8192, 7.5 / 16)) > 0.9f;
    EXPECT_GT(near, 990) << "a few are drawn from dim parts";
}

/// Every texel is in exactly one part, and in the one that is looked up for it.
TEST(EnvironmentParts, CoverTheImageOnce) {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {700, 300}, {512, 256}, {1, 9}}) {
        EnvironmentGrid grid(width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                grid.add(x, y, x == width / 3 && y == height / 4 ? 1e4 : 1.0 + (x * 7 + y) % 5, 1.0);
        std::vector<int> owners(static_cast<std::size_t>(width * height), -1);
        const std::vector<EnvironmentPart> parts = grid.parts(8);
        const auto part = [&](int i) -> const EnvironmentPart& { return parts[static_cast<std::size_t>(i)]; };
        EXPECT_LE(parts.size(), 8u);
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (int y = parts[i].y0; y < parts[i].y1; ++y)
                for (int x = parts[i].x0; x < parts[i].x1; ++x) {
                    ASSERT_EQ(owners[static_cast<std::size_t>(y * width + x)], -1);
                    owners[static_cast<std::size_t>(y * width + x)] = static_cast<int>(i);
                }
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int found = part_of(x, y, static_cast<int>(parts.size()), part);
                ASSERT_EQ(found, owners[static_cast<std::size_t>(y * width + x)]);
            }
    }
}

TEST(EnvironmentParts, ASunIsCutFree) {
    EnvironmentGrid grid(64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            grid.add(x, y, x == 20 && y == 10 ? 2048.0 : 1.0, 1.0);
    int smallest = 64 * 32;
    for (const EnvironmentPart& part : grid.parts(8))
        if (part.x0 <= 20 && 20 < part.x1 && part.y0 <= 10 && 10 < part.y1)
            smallest = (part.x1 - part.x0) * (part.y1 - part.y0);
    EXPECT_LE(smallest, 32);
}

}  // namespace
}  // namespace treefarm
