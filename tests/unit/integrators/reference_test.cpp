// SPDX-License-Identifier: Apache-2.0
// The reference estimator against the batch walk (worker/integrators/path), to the bit: both draw the same numbers. Not
// where the sky is an image, whose texels the batch reads by place and the reference by direction: there, and with
// glass split, they agree in expectation (tests/statistical/reference_test.cpp).
#include <gtest/gtest.h>

#include "common/config/job_reader.h"
#include "coordinator/input/load.h"
#include "tests/support/local_render.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

Job unguided(std::uint32_t spp) {
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.split_glass = false;
    job.budget.spp = spp;
    job.sampler.seed = 5;
    return job;
}

/// The passes of both, to the bit, and their counts of rays and vertices.
void expect_same_bits(const Scene& scene, Job job, const std::string& what) {
    job.integrator.type = "path";
    const test::LocalRender path = test::render_locally(scene, job);
    job.integrator.type = "reference";
    const test::LocalRender reference = test::render_locally(scene, job);
    ASSERT_EQ(path.passes.size(), reference.passes.size());
    std::size_t different = 0, lit = 0;
    for (std::size_t k = 0; k < path.passes.size(); ++k) {
        for (std::size_t p = 0; p < path.passes[k].pixels.size(); ++p)
            for (int half = 0; half < 2; ++half) {
                const Moments &a = path.passes[k].pixels[p].half[half], &b = reference.passes[k].pixels[p].half[half];
                different += a.n != b.n || a.mean != b.mean || a.m2 != b.m2;
                lit += a.mean != Rgb64(0.0);
            }
        EXPECT_EQ(path.stats[k].paths, reference.stats[k].paths) << what;
        EXPECT_EQ(path.stats[k].rays, reference.stats[k].rays) << what;
        EXPECT_EQ(path.stats[k].vertices, reference.stats[k].vertices) << what;
        EXPECT_EQ(path.stats[k].nonzero_paths, reference.stats[k].nonzero_paths) << what;
    }
    EXPECT_EQ(different, 0u) << what;
    EXPECT_GT(lit, 0u) << what << ": nothing was tested";
}

class OwnScenes : public testing::TestWithParam<const char*> {};

TEST_P(OwnScenes, TheReferenceIsTheUnguidedWalk) {
    const LoadedScene loaded = load_scene(test::own_scene(std::string(GetParam()) + ".xml"), {}, false, 24, 16);
    Job job = unguided(28);
    apply_layer(job, loaded.settings);
    job.budget.spp = 28;
    job.guiding.type = GuidingType::none;
    for (const NextEvent next_event : {NextEvent::always, NextEvent::never, NextEvent::kickstart}) {
        job.integrator.next_event = next_event;
        expect_same_bits(loaded.scene, job, GetParam());
    }
    job.integrator.next_event = NextEvent::always;
    for (const MisHeuristic mis : {MisHeuristic::power, MisHeuristic::equal}) {
        job.integrator.mis = mis;
        expect_same_bits(loaded.scene, job, GetParam());
    }
    job.integrator.strict_normals = job.farm.robust = true;
    // A camera inside a hidden furnace would see nothing.
    job.integrator.hide_emitters = std::string(GetParam()) != "white-furnace";
    job.integrator.max_depth = 4;
    job.integrator.rr_depth = 2;
    expect_same_bits(loaded.scene, job, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScenes,
                         testing::Values("caustic", "cornell-box", "diffuse-room", "door-ajar", "glossy-room",
                                         "matte-room", "mixed-room", "softboxes", "white-furnace"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::erase(name, '-');
                             return name;
                         });

/// A box with a lamp that is a sphere, a point light, a ball of glass and one that lets half of the rays pass, under a
/// constant sky.
TEST(Reference, IsTheUnguidedWalkWithEveryKindOfLight) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 20, 20);
    const std::int32_t grey = test::add_diffuse(scene, Rgb(0.5f)), glass = grey + 1, veil = grey + 2;
    scene.materials.push_back(scene.materials.back());
    scene.materials.back().bsdf = DielectricMaterial{};
    scene.materials.push_back(scene.materials[static_cast<std::size_t>(grey)]);
    scene.materials.back().opacity = FloatInput(0.5f);
    test::add_shape(scene, Sphere{{0.2f, 0.8f, 0.3f}, 0.05f, false}, grey, Rgb(20.0f));
    test::add_shape(scene, Sphere{{0.7f, 0.45f, 0.35f}, 0.15f, false}, glass);
    test::add_shape(scene, Sphere{{0.3f, 0.3f, 0.2f}, 0.15f, false}, veil);
    scene.emitters.push_back({PointEmitter{{0.9f, 0.9f, 0.1f}, Rgb(0.3f)}, {}});
    scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    for (const NextEvent next_event : {NextEvent::always, NextEvent::never}) {
        Job job = unguided(60);
        job.integrator.next_event = next_event;
        expect_same_bits(scene, job, "all kinds of light");
    }
}

/// However emitters are chosen: among few, and among so many that they have a hierarchy.
TEST(Reference, ChoosesEmittersAsTheWalk) {
    for (const int lamps : {3, 60}) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        test::set_film(scene, 16, 16);
        scene.emitters.push_back({ConstantEmitter{Rgb(0.1f)}, {}});
        for (int i = 0; i < lamps; ++i) {
            const Vec3 corner(0.05f + 0.08f * static_cast<float>(i % 10), 0.9f,
                              0.05f + 0.1f * static_cast<float>(i / 10));
            test::add_shape(scene, test::quad(corner, {0.03f, 0, 0}, {0, 0, 0.03f}), 0,
                            Rgb(static_cast<float>(1 + i % 7)));
        }
        for (const LightSelection how : {LightSelection::power, LightSelection::even, LightSelection::tree}) {
            Job job = unguided(12);
            job.integrator.light_selection = how;
            expect_same_bits(scene, job, std::to_string(lamps) + " lamps");
        }
    }
}

}  // namespace
}  // namespace treefarm
