// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "common/math/frame.h"
#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_scene.h"

namespace treefarm {
namespace {

using test::add_shape;

EmbreeScene only(decltype(Shape::geometry) geometry) {
    Scene scene;
    add_shape(scene, std::move(geometry), kNone);
    return EmbreeScene(std::move(scene.shapes), "avx2");
}

TEST(Disk, IsHitWithinItsEllipse) {
    const Disk disk{Vec3(1, 2, 3), Vec3(2, 0, 0), Vec3(0.5f, 1, 0)};
    const EmbreeScene geometry = only(disk);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-3.0f, 3.0f);
    for (int i = 0; i < 20000; ++i) {
        const float x = uniform(random), y = uniform(random);
        const float b = y, a = (x - 0.5f * y) / 2;  // x = 2 a + b / 2, y = b
        const float r2 = a * a + b * b;
        if (std::abs(r2 - 1) < 1e-4f) continue;
        const Vec3 d = Vec3(uniform(random), uniform(random), 2.0f);
        Hit hit;
        const bool found = geometry.intersect({Vec3(1 + x, 2 + y, 3) - d * 1.5f, d}, hit);
        ASSERT_EQ(found, r2 < 1) << a << " " << b;
        if (!found) continue;
        ASSERT_LT((hit.p - Vec3(1 + x, 2 + y, 3)).length(), 3e-6f);
        ASSERT_NEAR(hit.b1, a, 3e-6f);
        ASSERT_NEAR(hit.b2, b, 3e-6f);
        ASSERT_EQ(hit.ng, Vec3(0, 0, 1));
        ASSERT_EQ(geometry.disk_point(0, hit.b1, hit.b2).p, hit.p) << "picked points are hit points";
    }
    Hit hit;
    EXPECT_FALSE(geometry.intersect({Vec3(0, 2, 3), Vec3(1, 0, 0)}, hit)) << "in its plane";
    EXPECT_FALSE(geometry.occluded({Vec3(1, 2, 0), Vec3(0, 0, 1), 2.9f}));
    EXPECT_TRUE(geometry.occluded({Vec3(1, 2, 0), Vec3(0, 0, 1), 3.1f}));
}

TEST(Cylinder, IsHitOnItsSideFromOutsideAndInside) {
    Cylinder cylinder{Vec3(0, 0, 1), Vec3(0, 0, 3), 0.5f};
    const EmbreeScene geometry = only(cylinder);
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(-2, 0.3f, 2), Vec3(1, 0, 0)}, hit));
    EXPECT_LT((hit.p - Vec3(-0.4f, 0.3f, 2)).length(), 1e-6f);
    EXPECT_LT((hit.ng - Vec3(-0.8f, 0.6f, 0)).length(), 1e-6f);
    EXPECT_NEAR(hit.b1, 0.5f, 1e-6f);
    ASSERT_TRUE(geometry.intersect({Vec3(0, 0, 2.5f), Vec3(0, 1, 0)}, hit));
    EXPECT_LT((hit.p - Vec3(0, 0.5f, 2.5f)).length(), 1e-6f);
    EXPECT_LT((hit.ng - Vec3(0, 1, 0)).length(), 1e-6f);
    EXPECT_FALSE(geometry.intersect({Vec3(-2, 0.51f, 2), Vec3(1, 0, 0)}, hit));
    EXPECT_FALSE(geometry.intersect({Vec3(-2, 0, 3.01f), Vec3(1, 0, 0)}, hit)) << "beyond its end";
    EXPECT_FALSE(geometry.intersect({Vec3(0.1f, 0, 0), Vec3(0, 0, 1)}, hit)) << "through both open ends";
    ASSERT_TRUE(geometry.intersect({Vec3(0, 0, 0), Vec3(0.3f, 0, 1)}, hit)) << "in at an end, out at the side";
    EXPECT_LT((hit.p - Vec3(0.5f, 0, 0.5f / 0.3f)).length(), 1e-6f);
    EXPECT_FALSE(geometry.occluded({Vec3(-2, 0, 2), Vec3(1, 0, 0), 1.4f}));
    cylinder.flip_normals = true;
    ASSERT_TRUE(only(cylinder).intersect({Vec3(-2, 0, 2), Vec3(1, 0, 0)}, hit));
    EXPECT_LT((hit.ng - Vec3(1, 0, 0)).length(), 1e-6f);
}

TEST(Cylinder, SkewOnesAgreeWithTheirEquation) {
    const Cylinder c{Vec3(0.3f, -0.5f, 0.2f), Vec3(1.1f, 0.7f, 1.4f), 0.4f};
    const EmbreeScene geometry = only(c);
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 o(normal(random), normal(random), normal(random)), d(normal(random), normal(random), normal(random));
        Hit hit;
        if (!geometry.intersect({o, d}, hit)) continue;
        ++found;
        const Vec3 axis = normalize(c.p1 - c.p0), from = hit.p - c.p0;
        const Vec3 out = from - axis * dot(from, axis);
        ASSERT_NEAR(out.length(), 0.4f, 1e-6f);
        ASSERT_LT((out * (1 / 0.4f) - hit.ng).length(), 1e-5f);
        ASSERT_LT(cross(hit.p - o, normalize(d)).length(), 1e-5f) << "on the ray";
        ASSERT_EQ(geometry.cylinder_point(0, hit.b1, hit.ng).shape, hit.shape);
    }
    EXPECT_GT(found, 1000);
}

/// A mesh with texture coordinates that are neither orthogonal nor of unit length.
Mesh textured_mesh() {
    Mesh mesh = test::sphere_mesh(Vec3(0.1f, 0.2f, 0), 1.0f, 2, true);
    for (const Vec3& p : mesh.positions)
        mesh.uvs.emplace_back(2 * p.x + p.y, 0.5f * p.z - p.x + 3);
    return mesh;
}

Instance placed(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& t) {
    Instance instance;
    instance.group = 0;
    const Vec3 rows[4] = {x, y, z, t};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            instance.to_world[i][j] = rows[i][j];
    return instance;
}

/// Moves of the hit point are what the tangents make of moves of uv.
void expect_tangents(const EmbreeScene& geometry, const std::string& what) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 o = Vec3(normal(random), normal(random), normal(random)) * 3.0f;
        const Vec3 target = Vec3(normal(random), normal(random), normal(random)) * 0.4f;
        const Vec3 d = normalize(target - o);
        Hit a, b;
        if (!geometry.intersect({o, d}, a) || std::abs(dot(a.ng, d)) < 0.2f) continue;
        const Vec3 side = Frame(d).to_world(Vec3(normal(random), normal(random), 0)) * 1e-3f;
        if (!geometry.intersect({o + side, d}, b) || a.primitive != b.primitive || dot(a.ng, b.ng) < 0.9f) continue;
        const SurfaceDetail from = geometry.detail(a), to = geometry.detail(b);
        ASSERT_EQ(from.uv, geometry.uv(a));
        const Vec2 move = to.uv - from.uv;
        if (std::max(std::abs(move.x), std::abs(move.y)) > 0.008f)
            continue;  // across the seam, or close to a pole: far from linear
        const Vec3 exact = b.p - a.p, linear = from.dp_du * move.x + from.dp_dv * move.y;
        const float rate = from.dp_du.length() * std::abs(move.x) + from.dp_dv.length() * std::abs(move.y);
        const float noise = 1e-5f + 2e-6f * (from.dp_du.length() + from.dp_dv.length());
        ASSERT_LT((exact - linear).length(), 0.05f * rate + noise) << what << " at " << a.p << " uv " << from.uv;
        ASSERT_GT(cross(from.dp_du, from.dp_dv).length(), 0.0f);
        ++compared;
    }
    EXPECT_GT(compared, 300) << what;
}

std::vector<std::pair<std::string, decltype(Shape::geometry)>> all_kinds() {
    Mesh bare = test::sphere_mesh(Vec3(0.0f), 1.0f, 2, false);
    Sphere sphere{Vec3(0.2f, 0, 0), 0.9f, false, normalize(Vec3(1, 1, 0)), normalize(Vec3(1, -1, 0))};
    Sphere flipped = sphere;
    flipped.flip_normals = flipped.mirrored = true;
    Cylinder cylinder{Vec3(0, -1, 0), Vec3(0, 1, 0.5f), 0.8f, false, Vec3(1, 0, 0), false};
    Cylinder mirrored = cylinder;
    mirrored.mirrored = mirrored.flip_normals = true;
    const Disk disk{Vec3(0, 0, 0.1f), Vec3(1.5f, 0, 0.2f), Vec3(0.3f, 1, 0)};
    Disk mirrored_disk = disk;
    mirrored_disk.mirrored = true;
    return {
        {"bare mesh", bare}, {"mesh", textured_mesh()},        {"sphere", sphere},     {"flipped sphere", flipped},
        {"disk", disk},      {"mirrored disk", mirrored_disk}, {"cylinder", cylinder}, {"mirrored cylinder", mirrored}};
}

TEST(SurfaceDetail, TangentsFollowTextureCoordinates) {
    for (const auto& [what, shape] : all_kinds())
        expect_tangents(only(shape), what);
}

TEST(SurfaceDetail, TangentsFollowTextureCoordinatesUnderInstances) {
    for (const auto& [what, shape] : all_kinds()) {
        Scene scene;
        add_shape(scene, shape, kNone);
        scene.shapes[0].group = 0;
        add_shape(scene, placed({1, 0.3f, 0}, {0, -0.7f, 0.2f}, {0.1f, 0, 1.4f}, {0.2f, 0.1f, -0.3f}), kNone);
        expect_tangents(EmbreeScene(std::move(scene.shapes), "avx2"), what + " placed");
    }
}

TEST(SurfaceDetail, ConventionsOfEachShape) {
    const EmbreeScene sphere = only(Sphere{Vec3(0.0f), 2.0f, false});
    EXPECT_LT((sphere.uv(sphere.sphere_point(0, {0, 1, 0})) - Vec2(0.25f, 0.5f)).length(), 1e-6f);
    EXPECT_LT((sphere.uv(sphere.sphere_point(0, {0, -1e-3f, 1})) - Vec2(0.75f, 1e-3f / float(M_PI))).length(), 1e-6f);
    const EmbreeScene disk = only(Disk{});
    EXPECT_LT((disk.uv(disk.disk_point(0, 0, -0.5f)) - Vec2(0.5f, 0.75f)).length(), 1e-6f);
    Disk d;
    d.mirrored = true;
    const EmbreeScene mirrored_disk = only(d);
    EXPECT_LT((mirrored_disk.uv(mirrored_disk.disk_point(0, 0, -0.5f)) - Vec2(0.5f, 0.25f)).length(), 1e-6f);
    Sphere s;
    s.mirrored = true;
    const EmbreeScene mirrored_sphere = only(s);
    EXPECT_LT((mirrored_sphere.uv(mirrored_sphere.sphere_point(0, {0, 1, 0})) - Vec2(0.75f, 0.5f)).length(), 1e-6f);
    Cylinder c;
    const EmbreeScene cylinder = only(c);
    EXPECT_LT((cylinder.uv(cylinder.cylinder_point(0, 0.3f, {0, 1, 0})) - Vec2(0.25f, 0.3f)).length(), 1e-6f);
    c.mirrored = true;
    const EmbreeScene mirrored = only(c);
    EXPECT_LT((mirrored.uv(mirrored.cylinder_point(0, 0.3f, {0, 1, 0})) - Vec2(0.75f, 0.3f)).length(), 1e-6f);
}

TEST(SurfaceDetail, DegenerateCoordinatesGetAFrame) {
    Mesh mesh = test::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
    for (const auto& uvs :
         {std::vector<Vec2>(4, Vec2(0.3f, 0.3f)), std::vector<Vec2>{{0, 0}, {1, 1}, {2, 2}, {3, 3}}}) {
        mesh.uvs = uvs;
        const EmbreeScene geometry = only(mesh);
        const SurfaceDetail detail = geometry.detail(geometry.triangle_point(0, 0, 0.2f, 0.3f));
        EXPECT_NEAR(dot(normalize(detail.dp_du), normalize(detail.dp_dv)), 0.0f, 1e-6f);
        EXPECT_NEAR(detail.dp_du.z, 0.0f, 1e-6f);
    }
    const EmbreeScene sphere = only(Sphere{});
    const SurfaceDetail pole = sphere.detail(sphere.sphere_point(0, {0, 0, 1}));
    EXPECT_GT(cross(pole.dp_du, pole.dp_dv).length(), 0.1f);
    const EmbreeScene disk = only(Disk{});
    const SurfaceDetail center = disk.detail(disk.disk_point(0, 0, 0));
    EXPECT_GT(cross(center.dp_du, center.dp_dv).length(), 0.1f);
}

}  // namespace
}  // namespace treefarm
