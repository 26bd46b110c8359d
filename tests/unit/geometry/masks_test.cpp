// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_scene.h"

namespace treefarm {
namespace {

using test::add_shape;

/// Layers one unit apart in front of a wall at z = 10.
struct Layers {
    Layers(const std::vector<decltype(Shape::geometry)>& layers, const FloatInput& opacity, TextureSet set = {})
        : textures(std::move(set)), geometry(shapes(layers), "avx2", masks(layers.size(), opacity)) {}

    static std::vector<Shape> shapes(const std::vector<decltype(Shape::geometry)>& layers) {
        Scene scene;
        for (const auto& layer : layers)
            add_shape(scene, layer, kNone);
        add_shape(scene, test::quad({-9, -9, 10}, {18, 0, 0}, {0, 18, 0}), kNone);
        return scene.shapes;
    }
    ShapeMasks masks(std::size_t count, const FloatInput& opacity) const {
        ShapeMasks m;
        m.opacity.assign(count, opacity);
        m.opacity.emplace_back(1.0f);
        m.textures = &textures;
        return m;
    }

    TextureSet textures;
    EmbreeScene geometry;
};

Mesh layer(float z) {
    Mesh mesh = test::quad({-1, -1, z}, {2, 0, 0}, {0, 2, 0});
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

/// How often rays meet each shape.
std::vector<int> count(const EmbreeScene& geometry, int rays) {
    std::vector<int> met(geometry.shape_count());
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-0.4f, 0.4f);
    for (int i = 0; i < rays; ++i) {
        const Ray ray{Vec3(uniform(random), uniform(random), 0),
                      Vec3(0.1f * uniform(random), 0.1f * uniform(random), 1)};
        Hit hit;
        if (!geometry.intersect(ray, hit)) continue;
        ++met[hit.shape];
        // The same ray, asked in another way, passes the same layers.
        const bool wall = hit.shape + 1 == geometry.shape_count();
        EXPECT_EQ(geometry.occluded({ray.origin, ray.direction, 9.0f}), !wall);
        Hit again;
        EXPECT_TRUE(geometry.intersect(ray, again));
        EXPECT_EQ(again.shape, hit.shape);
    }
    return met;
}

constexpr int kRays = 100000;

void expect_fraction(int met, double fraction, const char* what) {
    EXPECT_NEAR(met / double(kRays), fraction, 5 * std::sqrt(fraction * (1 - fraction) / kRays)) << what;
}

TEST(Masks, FractionsOfRaysPassEachLayer) {
    const Layers layers({layer(1), layer(2), layer(3)}, FloatInput(0.3f));
    const std::vector<int> met = count(layers.geometry, kRays);
    expect_fraction(met[0], 0.3, "first");
    expect_fraction(met[1], 0.3 * 0.7, "second");
    expect_fraction(met[2], 0.3 * 0.49, "third");
    expect_fraction(met[3], 0.343, "wall");
}

TEST(Masks, BothSidesOfClosedShapesCount) {
    const Layers layers({Sphere{Vec3(0, 0, 2), 0.9f, false}, Cylinder{Vec3(0, -2, 5), Vec3(0, 2, 5), 0.9f},
                         Disk{Vec3(0, 0, 8), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                        FloatInput(0.3f));
    const std::vector<int> met = count(layers.geometry, kRays);
    expect_fraction(met[0], 1 - 0.49, "sphere");
    expect_fraction(met[1], 0.49 * (1 - 0.49), "cylinder");
    expect_fraction(met[2], 0.49 * 0.49 * 0.3, "disk");
    expect_fraction(met[3], 0.49 * 0.49 * 0.7, "wall");
}

TEST(Masks, WorkUnderInstances) {
    Scene scene;
    add_shape(scene, layer(1), kNone);
    add_shape(scene, Sphere{Vec3(0, 0, 3), 0.9f, false}, kNone);
    scene.shapes[0].group = scene.shapes[1].group = 0;
    add_shape(scene, Instance{0, {}}, kNone);
    Instance further{0, {}};
    further.to_world.translate(Vec3(0, 0, 5));
    add_shape(scene, further, kNone);
    const FloatInput opacity(0.3f), opaque(1.0f);
    const EmbreeScene geometry(scene.shapes, "avx2", {{opacity, opacity, opaque, opaque}, {}, nullptr});
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-0.4f, 0.4f);
    int met[4] = {0, 0, 0, 0}, passed = 0;
    for (int i = 0; i < kRays; ++i) {
        Hit hit;
        const Ray ray{Vec3(uniform(random), uniform(random), 0), Vec3(0, 0, 1)};
        const bool found = geometry.intersect(ray, hit);
        ASSERT_EQ(found, geometry.occluded(ray));
        if (found)
            ++met[2 * (hit.instance - 3) + hit.shape];
        else
            ++passed;
    }
    expect_fraction(met[0], 0.3, "first layer");
    expect_fraction(met[1], 0.7 * 0.51, "first sphere");
    expect_fraction(met[2], 0.7 * 0.49 * 0.3, "second layer");
    expect_fraction(passed, 0.343 * 0.343, "none");
}

TEST(Masks, CutOutsAreExact) {
    CheckerboardTexture board{Rgb(1.0f), Rgb(0.0f), {}};
    const Layers layers({layer(1), Sphere{Vec3(0, 0, 4), 1.5f, false}}, FloatInput(1.0f, 0),
                        TextureSet({{board, "", {}}}, {}));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    int first = 0;
    for (int i = 0; i < 20000; ++i) {
        const float x = uniform(random), y = uniform(random);
        if (std::abs(x) < 1e-5f || std::abs(y) < 1e-5f) continue;
        Hit hit;
        ASSERT_TRUE(layers.geometry.intersect({Vec3(x, y, 0), Vec3(0, 0, 1)}, hit));
        ASSERT_EQ(hit.shape == 0, (x < 0) == (y < 0)) << x << " " << y;
        first += hit.shape == 0;
        if (hit.shape == 2) continue;
        ASSERT_EQ(layers.geometry.opacity(hit), 1.0f);
    }
    EXPECT_GT(first, 9000);
    EXPECT_TRUE(layers.geometry.mask(0) != nullptr);
    EXPECT_TRUE(layers.geometry.mask(2) == nullptr);
}

TEST(Masks, OpacitiesBeyondTheirRangeAreBounded) {
    for (const auto& [opacity, fraction] : {std::pair{0.0f, 0.0}, {-1.0f, 0.0}, {2.0f, 1.0}, {std::nanf(""), 1.0}}) {
        const Layers layers({layer(1), Sphere{Vec3(0, 0, 4), 1.5f, false}}, FloatInput(opacity));
        EXPECT_EQ(count(layers.geometry, 1000)[0], int(1000 * fraction)) << opacity;
        EXPECT_EQ(count(layers.geometry, 1000)[2], int(1000 - 1000 * fraction)) << opacity;
    }
}

TEST(Masks, TexturesMustBeThere) {
    EXPECT_THROW(
        EmbreeScene(Layers::shapes({layer(1)}), "avx2", {{FloatInput(1.0f, 0), FloatInput(1.0f)}, {}, nullptr}),
        RunError);
    EXPECT_THROW(EmbreeScene(Layers::shapes({layer(1)}), "avx2", {{FloatInput(0.5f)}, {}, nullptr}), RunError);
}

}  // namespace
}  // namespace treefarm
