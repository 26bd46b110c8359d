// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_scene.h"

namespace treefarm {
namespace {

using test::add_shape;
using test::quad;
using test::sphere_mesh;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

EmbreeScene make(Scene scene) {
    return EmbreeScene(std::move(scene.shapes), "avx2");
}

TEST(Geometry, ReportsTheNearestSurface) {
    Scene scene;
    add_shape(scene, quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}), kNone);
    add_shape(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(0.25f, -0.5f, 0), Vec3(0, 0, 1)}, hit));
    EXPECT_EQ(hit.shape, 1u);
    EXPECT_EQ(hit.primitive, 0u);
    EXPECT_NEAR(hit.p.x, 0.25f, 1e-6f);
    EXPECT_NEAR(hit.p.y, -0.5f, 1e-6f);
    EXPECT_EQ(hit.p.z, 1.0f);
    EXPECT_EQ(hit.ng, Vec3(0, 0, 1));
    EXPECT_EQ(hit.ns, hit.ng);
    EXPECT_FALSE(geometry.intersect({Vec3(0, 0, 0), Vec3(0, 0, -1)}, hit));
}

TEST(Geometry, SegmentsEndWhereTheyEnd) {
    Scene scene;
    add_shape(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    EXPECT_TRUE(geometry.occluded({Vec3(0.1f, 0, 0), Vec3(0, 0, 2), 0.6f}));
    EXPECT_FALSE(geometry.occluded({Vec3(0.1f, 0, 0), Vec3(0, 0, 2), 0.4f}));
    EXPECT_TRUE(geometry.occluded({Vec3(0.1f, 0, 0), Vec3(0, 0, 1)}));
    EXPECT_FALSE(geometry.occluded({Vec3(0.1f, 0, 0), Vec3(0, 0, -1)}));
}

TEST(Geometry, UselessShadingNormalsFallBackToTheTriangles) {
    for (const Vec3& n :
         {Vec3(0.0f), Vec3(kNan), Vec3(0.0f, kNan, 1.0f), Vec3(std::numeric_limits<float>::infinity())}) {
        Scene scene;
        Mesh mesh = quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
        mesh.normals.assign(4, n);
        add_shape(scene, mesh, kNone);
        const EmbreeScene geometry = make(std::move(scene));
        Hit hit;
        ASSERT_TRUE(geometry.intersect({Vec3(0.1f, 0, 0), Vec3(0, 0, 1)}, hit));
        EXPECT_EQ(hit.ns, Vec3(0, 0, 1));
        EXPECT_EQ(hit.ng, Vec3(0, 0, 1));
    }
}

TEST(Geometry, FrontIsWhereTheShadingNormalPoints) {
    Scene scene;
    Mesh mesh = quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    mesh.normals.assign(4, normalize(Vec3(0.1f, 0, -1)));
    add_shape(scene, mesh, kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(0.1f, 0, 0), Vec3(0, 0, 1)}, hit));
    EXPECT_EQ(hit.ng, Vec3(0, 0, -1));
    EXPECT_GT(dot(hit.ng, hit.ns), 0.9f);
}

TEST(Geometry, InterpolatesNormalsAndTextureCoordinates) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    mesh.normals = {Vec3(0, 0, 1), normalize(Vec3(1, 0, 1)), normalize(Vec3(0, 1, 1))};
    mesh.uvs = {Vec2(0, 0), Vec2(2, 0), Vec2(0, 4)};
    mesh.indices = {0, 1, 2};
    add_shape(scene, mesh, kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(0.25f, 0.5f, 3), Vec3(0, 0, -1)}, hit));
    const Vec3 expected = normalize(mesh.normals[0] * 0.25f + mesh.normals[1] * 0.25f + mesh.normals[2] * 0.5f);
    EXPECT_LT((hit.ns - expected).length(), 1e-6f);
    EXPECT_NEAR(geometry.uv(hit).x, 0.5f, 1e-6f);
    EXPECT_NEAR(geometry.uv(hit).y, 2.0f, 1e-6f);
}

TEST(Geometry, BadTrianglesNeverGiveBadHits) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    Scene scene;
    Mesh mesh;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Vec3 a(uniform(random), uniform(random), uniform(random)),
            b(uniform(random), uniform(random), uniform(random));
        const float thin = std::pow(10.0f, -static_cast<float>(i % 10));
        // Slivers, triangles with two equal corners, points, and collinear corners.
        const Vec3 c = i % 7 == 0 ? a : i % 7 == 1 ? (a + b) * 0.5f : a + (b - a) * 0.5f + Vec3(thin, -thin, 0);
        for (const Vec3& p : {a, i % 11 == 0 ? a : b, c}) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(p);
        }
    }
    add_shape(scene, mesh, kNone);
    const EmbreeScene geometry = make(std::move(scene));
    int found = 0;
    for (int i = 0; i < 100000; ++i) {
        Hit hit;
        const Vec3 d(uniform(random), uniform(random), uniform(random));
        if (!geometry.intersect({Vec3(uniform(random), uniform(random), uniform(random)) * 2.0f, d}, hit)) continue;
        ++found;
        ASSERT_TRUE(is_finite(hit.p) && is_finite(hit.ng) && is_finite(hit.ns) && std::isfinite(hit.error));
        ASSERT_NEAR(hit.ng.length(), 1.0f, 1e-5f);
    }
    EXPECT_GT(found, 1000);
}

TEST(Geometry, AClosedMeshKeepsRandomRaysIn) {
    Scene scene;
    add_shape(scene, sphere_mesh(Vec3(0.1f, -0.2f, 0.3f), 1.5f, 4, false), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 300000; ++i) {
        Hit hit;
        ASSERT_TRUE(geometry.intersect({Vec3(normal(random), normal(random), normal(random)) * 0.05f,
                                        Vec3(normal(random), normal(random), normal(random))},
                                       hit));
    }
}

TEST(Geometry, SpheresFromOutsideAndInside) {
    Scene scene;
    add_shape(scene, Sphere{Vec3(1, 2, 3), 0.5f, false}, kNone);
    add_shape(scene, Sphere{Vec3(-5, 0, 0), 1.0f, true}, kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(1, 2, 0), Vec3(0, 0, 2)}, hit));
    EXPECT_EQ(hit.shape, 0u);
    EXPECT_LT((hit.p - Vec3(1, 2, 2.5f)).length(), 1e-6f);
    EXPECT_LT((hit.ng - Vec3(0, 0, -1)).length(), 1e-6f);
    ASSERT_TRUE(geometry.intersect({Vec3(1, 2, 3.1f), Vec3(0, 0, 1)}, hit));
    EXPECT_LT((hit.p - Vec3(1, 2, 3.5f)).length(), 1e-6f);
    EXPECT_LT((hit.ng - Vec3(0, 0, 1)).length(), 1e-6f);
    ASSERT_TRUE(geometry.intersect({Vec3(-9, 0, 0), Vec3(1, 0, 0)}, hit));
    EXPECT_EQ(hit.shape, 1u);
    EXPECT_LT((hit.ng - Vec3(1, 0, 0)).length(), 1e-6f) << "flipped normals point inwards";
    EXPECT_FALSE(geometry.occluded({Vec3(1.51f, 2, 0), Vec3(0, 0, 1)}));
    EXPECT_TRUE(geometry.occluded({Vec3(1.49f, 2, 0), Vec3(0, 0, 1)}));
}

TEST(Geometry, SmallSpheresFarAwayAreHit) {
    for (const float distance : {1e-3f, 1.0f, 1e3f, 1e6f})
        for (const float radius : {1e-6f, 1e-3f, 1.0f}) {
            if (radius >= 0.5f * distance) continue;
            Scene scene;
            add_shape(scene, Sphere{Vec3(0, 0, distance), radius, false}, kNone);
            const EmbreeScene geometry = make(std::move(scene));
            Hit hit;
            EXPECT_TRUE(geometry.intersect({Vec3(0.0f), Vec3(0, 0, 1)}, hit)) << distance << " " << radius;
            EXPECT_TRUE(geometry.intersect({Vec3(0.9f * radius, 0, 0), Vec3(0, 0, 1)}, hit))
                << distance << " " << radius;
            EXPECT_FALSE(geometry.intersect({Vec3(1.1f * radius, 0, 0), Vec3(0, 0, 1)}, hit))
                << distance << " " << radius;
        }
}

TEST(Geometry, LongRaysFindTheScene) {
    Scene scene;
    add_shape(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(0, 0, -1e4f), normalize(Vec3(5e-5f, 2.5e-5f, 1))}, hit));
    EXPECT_NEAR(hit.p.x, 0.5f, 2e-3f);
    EXPECT_NEAR(hit.p.y, 0.25f, 2e-3f);
    EXPECT_EQ(hit.p.z, 0.0f) << "the position lies on the triangle however long the ray";
}

TEST(Geometry, EmptyShapesKeepTheNumberingOfTheOthers) {
    Scene scene;
    add_shape(scene, Mesh{}, kNone);
    add_shape(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(0.1f, 0, 0), Vec3(0, 0, 1)}, hit));
    EXPECT_EQ(hit.shape, 1u);
    const EmbreeScene nothing({}, "avx2");
    EXPECT_FALSE(nothing.intersect({Vec3(0.0f), Vec3(0, 0, 1)}, hit));
}

TEST(Geometry, WrongIndicesAreRefused) {
    Scene scene;
    Mesh mesh = quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    mesh.indices[4] = 4;
    add_shape(scene, mesh, kNone, Rgb(0.0f), "torn");
    try {
        make(std::move(scene));
        FAIL() << "an index out of range must be refused";
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("torn"), std::string::npos) << error.what();
    }
}

TEST(Geometry, AnInstructionSetThatIsNotThereIsRefused) {
    EXPECT_THROW(EmbreeScene({}, "avx1024"), RunError);
    EXPECT_NO_THROW(EmbreeScene({}, "sse4.2"));
}

TEST(Geometry, PickedPointsAreTheHitPoints) {
    Scene scene;
    add_shape(scene, sphere_mesh(Vec3(3, 1, 2), 2.0f, 2, true), kNone);
    const EmbreeScene geometry = make(std::move(scene));
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 1000; ++i) {
        Hit hit;
        ASSERT_TRUE(geometry.intersect({Vec3(3, 1, 2), Vec3(normal(random), normal(random), normal(random))}, hit));
        const Hit same = geometry.triangle_point(hit.shape, hit.primitive, hit.b1, hit.b2);
        ASSERT_EQ(same.p, hit.p);
        ASSERT_EQ(same.ng, hit.ng);
        ASSERT_EQ(same.ns, hit.ns);
    }
}

constexpr std::size_t kMasked = 4;

/// Meshes, a group placed, a ball, a disk, and a quad to be masked: whatever rays can meet.
Scene varied_scene() {
    Scene scene;
    const std::int32_t grey = test::add_diffuse(scene, Rgb(0.5f));
    add_shape(scene, sphere_mesh(Vec3(0.0f), 1.0f, 4, true), grey);
    add_shape(scene, quad({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}), grey);
    add_shape(scene, Sphere{Vec3(2, 0, 0), 0.9f}, grey);
    add_shape(scene, Disk{Vec3(-2, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, grey);
    add_shape(scene, quad({-3, 1.5f, -3}, {6, 0, 0}, {0, 0, 6}), grey);
    for (const Vec3& center : {Vec3(0.0f), Vec3(0.7f, 0, 0)}) {
        add_shape(scene, sphere_mesh(center, 0.6f, 3, false), grey);
        scene.shapes.back().group = 0;
    }
    scene.group_count = 1;
    Imath::M44f placed;
    placed.translate(Vec3(0, -2.5f, 0));
    add_shape(scene, Instance{0, placed}, kNone);
    return scene;
}

/// Rays that are found together start anywhere and point anywhere, to vertices and edges, too.
TEST(Geometry, WhatARayHitsDoesNotDependOnOtherRays) {
    for (const char* isa : {"sse2", "avx", "avx2"}) {
        const Scene scene = varied_scene();
        const std::vector<Vec3>& corners = std::get<Mesh>(scene.shapes[0].geometry).positions;
        std::vector<FloatInput> opacity(scene.shapes.size(), FloatInput(1.0f));
        opacity[kMasked] = FloatInput(0.5f);
        const EmbreeScene geometry(scene.shapes, isa, {opacity, {}, nullptr});
        std::mt19937 random(5);
        std::normal_distribution<float> normal;
        std::uint32_t met = 0;
        for (int round = 0; round < 2000; ++round) {
            std::array<Ray, 19> rays;
            std::array<EmbreeScene::EmbreeHit, 19> embree_hits;
            std::array<bool, 19> found;
            std::vector<EmbreeScene::Query> queries;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Vec3 from = Vec3(normal(random), normal(random), normal(random)) * 2.0f;
                const Vec3 to = i % 3 == 0   ? corners[random() % corners.size()]
                                : i % 3 == 1 ? (corners[random() % corners.size()] + corners[0]) * 0.5f
                                             : Vec3(normal(random), normal(random), normal(random));
                rays[i] = {from, to - from};
                if (i % 5 == 0) rays[i].length = 1.1f;
                queries.push_back({&rays[i], &embree_hits[i], &found[i]});
            }
            geometry.intersect(queries);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EmbreeScene::EmbreeHit alone;
                bool found_alone;
                const EmbreeScene::Query query{&rays[i], &alone, &found_alone};
                geometry.intersect({&query, 1});
                ASSERT_EQ(found[i], found_alone) << isa;
                if (!found[i]) continue;
                ++met;
                const EmbreeScene::EmbreeHit& m = embree_hits[i];
                ASSERT_EQ(std::tie(m.instance, m.id, m.primitive, m.u, m.v, m.outward),
                          std::tie(alone.instance, alone.id, alone.primitive, alone.u, alone.v, alone.outward))
                    << isa;
            }
        }
        EXPECT_GT(met, 20'000u);
    }
}

}  // namespace
}  // namespace treefarm
