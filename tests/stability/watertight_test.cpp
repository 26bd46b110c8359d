// SPDX-License-Identifier: Apache-2.0
// Closed rooms under farm.robust: what no ray may leave, and no light enter.
#include "tests/support/closed_rooms.h"
#include "tests/support/hard_case.h"

namespace treefarm {
namespace {

using Imath::V3d;

/// 12, 15 | A closed room lets nothing out
/// Others: rays slipped through edges that triangles share (pbrt Triangle.Watertight), and started behind the wall of a
/// corner, because positions far from the origin are coarse (Mitsuba 3 #219, huira #46).
/// Here: with farm.robust Embree's test is watertight, and a hit near another surface steps back along its ray until
/// none is within what rounding can move.
/// Holds: of a million paths at each of 1, 1,000 and 10,000 sizes from the origin, in boxes along the axes and turned,
/// of 12 and of 768 triangles, with a box in the floor, in a ball and in an instanced box, none leaves.
TEST(Watertight, NoPathLeavesAClosedRoom) {
    constexpr long kPaths = 1'000'000;
    for (const double away : {1.0, 1000.0, 10000.0}) {
        std::vector<test::ClosedRoom> rooms = test::closed_rooms(away);
        const long each = kPaths / static_cast<long>(rooms.size()) + 1;
        for (test::ClosedRoom& room : rooms) {
            const EmbreeScene geometry(std::move(room.shapes), "avx2", {}, true);
            EXPECT_EQ(test::escapes(geometry, room.at, each, 4, 7), 0) << room.name << ", " << away << " sizes away";
        }
    }
    test::figure("paths that left, of 3 million", 0);
}

/// 12, 15 | A corner narrower than a ray's offset
/// Others: an offset along the normal of one wall led through the other (pbrt 6.8, huira #46).
/// Here: see above; a ray that finds no room ahead of it goes back as far as it came.
/// Holds: in wedges of 0.1 to 60 degrees, at 1 and 1,000 sizes from the origin, paths of 40 rays never leave.
TEST(Watertight, NoPathLeavesAWedge) {
    for (const double away : {1.0, 1000.0})
        for (const double degrees : {0.1, 1.0, 10.0, 60.0}) {
            const V3d at = V3d(1.0, -0.7, 0.3).normalized() * away;
            const double height = std::tan(degrees * 0.017453292519943295);
            // A prism over a triangle that is pointed at its first corner.
            const V3d corners[] = {{0, 0, 0}, {1, 0, 0}, {1, height, 0}, {0, 0, 1}, {1, 0, 1}, {1, height, 1}};
            Mesh prism;
            for (const V3d& p : corners)
                prism.positions.push_back(Vec3(p + at));
            prism.indices = {0, 1, 2, 3, 5, 4, 0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2, 2, 5, 3, 2, 3, 0};
            Scene scene;
            test::add_shape(scene, prism, kNone);
            const EmbreeScene geometry(std::move(scene.shapes), "avx2", {}, true);
            // escapes() starts beside the middle.
            const V3d middle = at + V3d(0.9, 0.45 * height, 0.5) - V3d(0.1, 0.05, -0.07);
            EXPECT_EQ(test::escapes(geometry, middle, 2000, 40, 11), 0) << degrees << " degrees, " << away << " away";
        }
    test::figure("paths that left, of 16000", 0);
}

/// 12, 15 | A closed room in a bright world is black
/// Others: light leaked along edges (GLSL-PathTracer #35).
/// Here: see above, for whole paths with next event.
/// Holds: a closed box of albedo 0.9 in an environment of radiance a million, 1, 1,000 and 10,000 sizes from the
/// origin: every pixel of 64 x 64 is black after 16 samples of 12 edges, guided or not.
TEST(Watertight, ARoomInABrightWorldIsBlack) {
    for (const bool guided : {false, true})
        for (const double away : {1.0, 1000.0, 10000.0}) {
            const V3d at = V3d(1.0, -0.7, 0.3).normalized() * away;
            Scene scene;
            const std::int32_t material = test::add_diffuse(scene, Rgb(0.9f), true);
            test::add_shape(scene, test::turned_box(at, 0.7, 0.4, 1, true), material);
            scene.emitters.push_back({ConstantEmitter{Rgb(1e6f)}, {}});
            scene.camera = test::look_at(Vec3(at), Vec3(at) + Vec3(0.25f, -0.5f, 0.25f), Vec3(0, 1, 0), 1.5f);
            test::set_film(scene, 64, 64);
            Job job = guided ? test::guided_job(15, 12, NextEvent::always) : test::plain_job(16, 12, NextEvent::always);
            job.farm.robust = true;
            const test::LocalRender run = test::render_locally(scene, job);
            double sum = 0;
            for (const Rgb64& pixel : run.image.mean)
                sum += pixel.x;
            EXPECT_EQ(sum, 0.0) << away << " sizes away";
        }
    test::figure("sum of all pixels", 0);
}

}  // namespace
}  // namespace treefarm
