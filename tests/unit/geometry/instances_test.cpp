// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "tests/support/resolved.h"
#include "tests/support/test_scenes.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {
namespace {

using test::add_shape;

Imath::M44f matrix(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& t) {
    Imath::M44f m;
    const Vec3 rows[4] = {x, y, z, t};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            m[i][j] = rows[i][j];
    return m;
}

/// Uneven scales, a shear, a mirror image.
std::vector<Imath::M44f> placements() {
    return {matrix({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 0, 0}),
            matrix({0.6f, 0.8f, 0}, {-1.6f, 1.2f, 0}, {0, 0, 0.5f}, {0, 3, 0.2f}),
            matrix({1, 0.2f, 0}, {0, 1, 0.4f}, {0.3f, 0, 1}, {0, 0, 4}),
            matrix({-1, 0, 0}, {0, 0.8f, 0.1f}, {0, 0, 1.3f}, {-3, 0, 0})};
}

Mesh member() {
    Mesh mesh = test::sphere_mesh(Vec3(0.1f, 0, 0.2f), 1.0f, 3, true);
    for (const Vec3& p : mesh.positions)
        mesh.uvs.emplace_back(2 * p.x + p.y, p.z);
    return mesh;
}

Vec3 transformed_normal(const Vec3& n, const Imath::M44f& inverse) {
    Vec3 result;
    for (int i = 0; i < 3; ++i)
        result[i] = n.x * inverse[i][0] + n.y * inverse[i][1] + n.z * inverse[i][2];
    return normalize(result);
}

Mesh flattened(const Mesh& mesh, const Imath::M44f& m) {
    Mesh flat = mesh;
    const Imath::M44f inverse = m.inverse();
    for (Vec3& p : flat.positions)
        p = p * m;
    for (Vec3& n : flat.normals)
        n = transformed_normal(n, inverse);
    if (m.determinant() < 0)
        for (std::size_t i = 0; i < flat.indices.size(); i += 3)
            std::swap(flat.indices[i], flat.indices[i + 1]);
    return flat;
}

/// The floor, a lamp, and a group of a mesh and a ball, four times; or the same without instances (the ball is a mesh).
Scene make_scene(bool instances) {
    Scene scene;
    const std::int32_t grey = test::add_diffuse(scene, Rgb(0.6f), true),
                       red = test::add_diffuse(scene, {0.7f, 0.2f, 0.1f});
    add_shape(scene, test::quad({-8, -8, -2}, {16, 0, 0}, {0, 16, 0}), grey, Rgb(0.0f), "floor");
    const Mesh ball = test::sphere_mesh(Vec3(0, 0, 1.5f), 0.4f, 2, true);
    if (instances) {
        for (const Mesh& mesh : {member(), ball}) {
            add_shape(scene, mesh, red, Rgb(0.0f), "member");
            scene.shapes.back().group = 0;
        }
        scene.group_count = 1;
    }
    for (const Imath::M44f& m : placements()) {
        if (instances) {
            add_shape(scene, Instance{0, m}, kNone, Rgb(0.0f), "instance");
        } else {
            add_shape(scene, flattened(member(), m), red);
            add_shape(scene, flattened(ball, m), red);
        }
    }
    add_shape(scene, test::quad({-2, -2, 8}, {0, 4, 0}, {4, 0, 0}), grey, Rgb(5.0f), "lamp");
    scene.camera = test::look_at(Vec3(6, -9, 4), Vec3(0, 0, 1), Vec3(0, 0, 1), 0.6f);
    test::set_film(scene, 32, 32);
    return scene;
}

TEST(Instances, AreHitLikeTheFlattenedMeshes) {
    const EmbreeScene placed(make_scene(true).shapes, "avx2"), flat(make_scene(false).shapes, "avx2");
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    int on_members = 0, different = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 o = Vec3(normal(random), normal(random), normal(random)) * 3.0f;
        const Vec3 d = normalize(Vec3(normal(random), normal(random), normal(random)));
        Hit a, b;
        const bool hit_a = placed.intersect({o, d}, a), hit_b = flat.intersect({o, d}, b);
        ASSERT_EQ(hit_a, placed.occluded({o, d}));
        if (hit_a != hit_b || (hit_a && (a.primitive != b.primitive || (a.p - b.p).length() > 1e-4f))) {
            ++different;  // at an edge
            continue;
        }
        if (!hit_a || a.instance == 0) continue;
        ++on_members;
        ASSERT_EQ(placed.shape(a.shape).name, "member");
        ASSERT_EQ(placed.shape(a.instance - 1).name, "instance");
        ASSERT_LT((a.ng - b.ng).length(), 1e-4f);
        // Uneven scales do not commute with interpolation, so the flattened mesh shades a little differently between
        // its vertices: the normal is that of the member, transformed.
        const Hit local = placed.triangle_point(a.shape, a.primitive, a.b1, a.b2);
        const Imath::M44f m = placements()[a.instance - 4];
        ASSERT_LT((a.ns - transformed_normal(local.ns, m.inverse())).length(), 1e-5f);
        ASSERT_LT((a.p - local.p * m).length(), 1e-5f);
        const SurfaceDetail da = placed.detail(a), db = flat.detail(b);
        if ((b.shape & 1) == 1) {  // the textured member; corners are exchanged in mirrored bare meshes
            ASSERT_LT((placed.uv(a) - flat.uv(b)).length(), 1e-3f);
            ASSERT_LT((da.dp_du - db.dp_du).length(), 1e-3f * db.dp_du.length());
            ASSERT_LT((da.dp_dv - db.dp_dv).length(), 1e-3f * db.dp_dv.length());
        }
    }
    EXPECT_GT(on_members, 5000);
    EXPECT_LT(different, 50);
}

TEST(Instances, LookLikeTheFlattenedMeshes) {
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.max_depth = 4;
    job.integrator.rr_depth = 100;
    const auto render = [&](bool instances) {
        const Scene scene = make_scene(instances);
        const TraceScene trace(scene, resolve(job, scene));
        const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
        PassPlan pass;
        pass.spp = 32;
        pass.next_event = true;
        pass.blocks_per_unit = 64;
        std::vector<PixelEstimate> pixels;
        RecordLog log;
        UnitStats stats;
        test::render_unit(trace, job, pass, guide, {0, 0, 0, 32, 32, 0}, pixels, log, stats);
        EXPECT_EQ(stats.invalid_samples, 0u);
        return pixels;
    };
    const auto placed = render(true), flat = render(false);
    int different = 0;
    double sum_placed = 0, sum_flat = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const double a = placed[i].whole().mean.x, b = flat[i].whole().mean.x;
        sum_placed += a;
        sum_flat += b;
        different += std::abs(a - b) > 1e-3 * (a + b) + 1e-6;
    }
    EXPECT_NEAR(sum_placed / sum_flat, 1.0, 2e-3);
    EXPECT_LT(different, 60) << "of 1024 pixels: paths that pass an edge on the other side";
}

TEST(Instances, AnalyticMembersKeepTheirPosition) {
    Scene scene;
    add_shape(scene, Sphere{Vec3(0.0f), 1.0f, false}, kNone);
    add_shape(scene, Disk{Vec3(5, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, kNone);
    add_shape(scene, Cylinder{Vec3(0, 5, -1), Vec3(0, 5, 1), 0.5f}, kNone);
    for (Shape& shape : scene.shapes)
        shape.group = 1;
    add_shape(scene, Instance{1, matrix({2, 0, 0}, {0, 1, 0}, {0, 0, -3}, {10, 0, 0})}, kNone);
    add_shape(scene, Instance{0, {}}, kNone);  // a group without shapes
    const EmbreeScene geometry(std::move(scene.shapes), "avx2");
    Hit hit;
    ASSERT_TRUE(geometry.intersect({Vec3(10, 0, 9), Vec3(0, 0, -1)}, hit));
    EXPECT_EQ(hit.shape, 0u);
    EXPECT_EQ(hit.instance, 4u);
    EXPECT_LT((hit.p - Vec3(10, 0, 3)).length(), 1e-5f);
    EXPECT_LT((hit.ng - Vec3(0, 0, 1)).length(), 1e-6f) << "outside stays outside in a mirror";
    ASSERT_TRUE(geometry.intersect({Vec3(11, 0, 9), Vec3(0, 0, -1)}, hit));
    EXPECT_LT((hit.p - Vec3(11, 0, 3 * std::sqrt(0.75f))).length(), 1e-5f);
    EXPECT_LT((hit.ng - normalize(Vec3(0.25f, 0, std::sqrt(0.75f) / 3))).length(), 1e-5f);
    ASSERT_TRUE(geometry.intersect({Vec3(21.5f, 0.1f, 9), Vec3(0, 0, -1)}, hit));
    EXPECT_EQ(hit.shape, 1u);
    EXPECT_LT((hit.p - Vec3(21.5f, 0.1f, 0)).length(), 1e-5f);
    EXPECT_LT((hit.ng - Vec3(0, 0, -1)).length(), 1e-6f);
    ASSERT_TRUE(geometry.intersect({Vec3(0, 5, 1.5f), Vec3(1, 0, 0)}, hit));
    EXPECT_EQ(hit.shape, 2u);
    EXPECT_LT((hit.p - Vec3(9, 5, 1.5f)).length(), 1e-5f);
    EXPECT_LT((geometry.uv(hit) - Vec2(0.5f, 0.25f)).length(), 1e-5f);
}

TEST(Instances, BadOnesAreRefused) {
    Scene flat;
    add_shape(flat, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone);
    flat.shapes[0].group = 0;
    add_shape(flat, Instance{0, matrix({1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 0})}, kNone);
    EXPECT_THROW(EmbreeScene(flat.shapes, "avx2"), RunError) << "no inverse";
    std::get<Instance>(flat.shapes[1].geometry).to_world = {};
    flat.shapes[1].group = 0;
    EXPECT_THROW(EmbreeScene(flat.shapes, "avx2"), RunError) << "an instance in a group";
    flat.shapes[1].group = kNone;
    flat.shapes[0].group = 2000000000;
    EXPECT_THROW(EmbreeScene(flat.shapes, "avx2"), RunError) << "a number out of all proportion";
}

}  // namespace
}  // namespace treefarm
