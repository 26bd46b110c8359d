// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "common/math/warp_batch.h"
#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_scene.h"

namespace treefarm {
namespace {

using test::add_shape;

std::uint32_t bits(float f) {
    return std::bit_cast<std::uint32_t>(f);
}

void expect_same(const Vec3& a, const Vec3& b) {
    EXPECT_EQ(bits(a.x), bits(b.x));
    EXPECT_EQ(bits(a.y), bits(b.y));
    EXPECT_EQ(bits(a.z), bits(b.z));
}

KeyBatch keys() {
    KeyBatch keys;
    for (std::uint32_t i = 0; i < kDrawBatch; ++i) {
        keys.pixel[i] = i * 2654435761u;
        keys.sample[i] = i * i;
    }
    return keys;
}

TEST(Batch, DrawsAreThoseOfEachPath) {
    const std::uint64_t seed = 0x123456789abcdefULL;
    for (const std::uint32_t count : {1u, 8u, 9u, 31u, kDrawBatch}) {
        DrawBatch draws;
        draw_batch(seed, keys(), count, 7, Stream::light, draws);
        for (std::uint32_t i = 0; i < count; ++i)
            EXPECT_EQ(draws[i], draw({seed, keys().pixel[i], keys().sample[i]}, 7, Stream::light))
                << i << " of " << count;
    }
}

TEST(Batch, DirectionsAreThoseOfEachPath) {
    for (std::uint32_t vertex = 0; vertex < 500; ++vertex) {
        DrawBatch draws;
        draw_batch(1, keys(), kDrawBatch, vertex, Stream::scatter, draws);
        if (vertex == 0) {  // centre, corners and middles of edges of the square
            draws.word[2] = {0, 0, 0, 1u << 31, 1u << 31, 1u << 31, ~0u, ~0u, ~0u};
            draws.word[3] = {0, 1u << 31, ~0u, 0, 1u << 31, ~0u, 0, 1u << 31, ~0u};
        }
        VectorBatch cosines, directions;
        cosine_hemisphere_batch(draws, kDrawBatch, cosines);
        std::array<float, kDrawBatch> x, y;
        for (std::uint32_t i = 0; i < kDrawBatch; ++i) {
            x[i] = to_unit(draws.word[2][i]);
            y[i] = to_unit(draws.word[3][i]);
        }
        square_to_direction_batch(x, y, kDrawBatch, directions);
        std::array<std::uint32_t, kDrawBatch> codes;
        direction_to_code_batch(directions, kDrawBatch, codes);
        for (std::uint32_t i = 0; i < kDrawBatch; ++i) {
            expect_same(cosines[i], square_to_cosine_hemisphere({x[i], y[i]}));
            expect_same(directions[i], square_to_direction({x[i], y[i]}));
            EXPECT_EQ(codes[i], direction_to_code(directions[i]));
            EXPECT_NEAR(directions[i].length(), 1.0f, 1e-6f);
        }
    }
}

/// Shapes of all kinds in a cloud, some of which let rays pass.
EmbreeScene cloud() {
    Scene scene;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    for (int i = 0; i < 20; ++i) {
        add_shape(scene, test::quad(vector(), vector() * 0.3f, vector() * 0.3f), kNone);
        add_shape(scene, Sphere{vector(), 0.1f, false}, kNone);
        add_shape(scene, Disk{vector(), {0.1f, 0, 0}, {0, 0.2f, 0}}, kNone);
        add_shape(scene, Cylinder{vector(), vector(), 0.03f}, kNone);
    }
    std::vector<FloatInput> opacity;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        opacity.emplace_back(i % 3 == 0 ? 0.5f : 1.0f);
    add_shape(scene, test::sphere_mesh(Vec3(0.0f), 0.2f, 2, false), kNone);
    scene.shapes.back().group = 0;
    opacity.emplace_back(0.7f);
    for (int i = 0; i < 10; ++i) {
        Instance instance{0, {}};
        instance.to_world.translate(vector());
        add_shape(scene, instance, kNone);
        opacity.emplace_back(1.0f);
    }
    return EmbreeScene(std::move(scene.shapes), "avx2", {opacity, {}, nullptr});
}

/// The other shadow rays of a packet must not decide what a ray hits.
TEST(Batch, ShadowRaysTogetherAreThoseOneByOne) {
    const EmbreeScene geometry = cloud();
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    int hidden_rays = 0, rays_in_all = 0;
    for (int batch = 0; batch < 4000; ++batch) {
        std::vector<Ray> rays(1 + random() % EmbreeScene::kMostTogether);
        for (Ray& ray : rays)
            ray = {vector(), vector(), random() % 7 == 0 ? -1.0f : 1.0f};
        std::array<bool, EmbreeScene::kMostTogether> hidden;
        geometry.occluded(rays, hidden.data());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool alone = rays[i].length > 0.0f && geometry.occluded(rays[i]);
            ASSERT_EQ(hidden[i], alone) << "ray " << i << " of batch " << batch;
            hidden_rays += alone;
            ++rays_in_all;
        }
    }
    EXPECT_GT(hidden_rays, rays_in_all / 10);
    EXPECT_LT(hidden_rays, rays_in_all * 9 / 10);
}

}  // namespace
}  // namespace treefarm
