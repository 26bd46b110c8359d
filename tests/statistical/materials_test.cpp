// SPDX-License-Identifier: Apache-2.0
// Paths over every kind of material: guided against unguided, and scenes whose radiance is known.
#include <gtest/gtest.h>

#include "common/config/job.h"
#include "common/metrics/z_test.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

struct MaterialEstimate {
    RgbImage mean, variance;
};

MaterialEstimate render_material(const Scene& scene, const Job& job) {
    const test::LocalRender run = test::render_locally(scene, job);
    for (const TraceStats& stats : run.stats)
        EXPECT_EQ(stats.invalid_samples, 0u);
    MaterialEstimate e{RgbImage(scene.film.width, scene.film.height), RgbImage(scene.film.width, scene.film.height)};
    for (std::size_t p = 0; p < e.mean.pixels.size(); ++p) {
        e.mean.pixels[p] = Rgb(run.image.mean[p]);
        e.variance.pixels[p] = Rgb(run.image.variance[p]);
    }
    return e;
}

/// The job that tests of glossy scenes start from.
Job short_job(std::uint64_t seed, std::uint32_t spp) {
    Job job;
    job.integrator.max_depth = 10;
    job.sampler.seed = seed;
    job.budget.spp = spp;
    job.guiding.type = GuidingType::none;
    job.integrator.next_event = NextEvent::always;
    return job;
}

struct Guiding {
    NextEvent next_event = NextEvent::always;
    GuidingType type = GuidingType::ppg;
    ViewRecords records = ViewRecords::product;
    bool learned = true;
};

void PrintTo(const Guiding& g, std::ostream* out) {
    *out << "next event " << static_cast<int>(g.next_event) << ", type " << static_cast<int>(g.type) << ", records "
         << static_cast<int>(g.records) << (g.learned ? ", learned" : "");
}

class GuidedMaterials : public ::testing::TestWithParam<Guiding> {};

TEST_P(GuidedMaterials, AgreeWithUnguided) {
    const Scene scene = test::glossy_room();
    const MaterialEstimate unguided = render_material(scene, short_job(1, 512));
    Job job = short_job(2, 508);
    job.guiding.type = GetParam().type;
    job.guiding.view_records = GetParam().records;
    job.guiding.view_threshold = 300;
    job.guiding.learn_bsdf_fraction = GetParam().learned;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;
    job.integrator.next_event = GetParam().next_event;
    const MaterialEstimate guided = render_material(scene, job);
    const BlockZTest blocks = block_z_test({guided.mean, unguided.mean, &guided.variance, &unguided.variance});
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z << " at " << blocks.worst_x << ", "
                             << blocks.worst_y;
    for (const double z : blocks.image_z)
        EXPECT_LT(std::abs(z), 4.0);
}

INSTANTIATE_TEST_SUITE_P(NextEvent, GuidedMaterials,
                         ::testing::Values(Guiding{}, Guiding{NextEvent::never}, Guiding{NextEvent::kickstart}));

INSTANTIATE_TEST_SUITE_P(
    ByView, GuidedMaterials,
    ::testing::Values(Guiding{NextEvent::always, GuidingType::view}, Guiding{NextEvent::never, GuidingType::view},
                      Guiding{NextEvent::kickstart, GuidingType::view},
                      Guiding{NextEvent::always, GuidingType::view, ViewRecords::product, false},
                      Guiding{NextEvent::kickstart, GuidingType::view, ViewRecords::radiance, false},
                      Guiding{NextEvent::always, GuidingType::view, ViewRecords::radiance, true},
                      Guiding{NextEvent::always, GuidingType::automatic},
                      Guiding{NextEvent::kickstart, GuidingType::automatic}));

/// Next event finds what scattering finds, and no more, on every material.
TEST(Materials, NextEventAgreesWithScattering) {
    const Scene scene = test::glossy_room();
    const MaterialEstimate with = render_material(scene, short_job(3, 512));
    Job job = short_job(4, 2048);
    job.integrator.next_event = NextEvent::never;
    const MaterialEstimate without = render_material(scene, job);
    const BlockZTest blocks = block_z_test({with.mean, without.mean, &with.variance, &without.variance});
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z;
}

/// Radiance 1 all around: what neither absorbs nor creates light is invisible in it.
class InvisibleBall : public ::testing::TestWithParam<std::pair<const char*, decltype(Material::bsdf)>> {};

TEST_P(InvisibleBall, CarriesTheRadianceAroundIt) {
    for (const bool guided : {false, true}) {
        Scene scene;
        const std::int32_t material = test::add_material(scene, GetParam().second);
        test::add_shape(scene, Sphere{Vec3(0.0f), 1.0f}, material);
        scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
        scene.camera = test::look_at(Vec3(0, 0, -3), Vec3(0.0f), Vec3(0, 1, 0), 0.3f);
        test::set_film(scene, 12, 12);
        Job job = short_job(5, 252);
        job.integrator.max_depth = 200;
        job.guiding.type = guided ? GuidingType::ppg : GuidingType::none;
        job.guiding.combination = Combination::fixed;
        const MaterialEstimate image = render_material(scene, job);
        double mean = 0, variance = 0;
        for (std::size_t p = 0; p < image.mean.pixels.size(); ++p) {
            mean += double(image.mean.pixels[p].y);
            variance += double(image.variance.pixels[p].y);
        }
        const double count = static_cast<double>(image.mean.pixels.size());
        EXPECT_NEAR(mean / count, 1.0, 4 * std::sqrt(variance) / count + 1e-3) << GetParam().first << guided;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, InvisibleBall,
    ::testing::Values(
        std::pair<const char*, decltype(Material::bsdf)>{"glass", DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), {}}},
        std::pair<const char*, decltype(Material::bsdf)>{"bubble", DielectricMaterial{0.8f, Rgb(1.0f), Rgb(1.0f), {}}},
        std::pair<const char*, decltype(Material::bsdf)>{
            "slightly rough glass",
            DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), test::rough(Microfacets::ggx, 0.003f, 0.003f)}},
        std::pair<const char*, decltype(Material::bsdf)>{"pane", ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f)}},
        std::pair<const char*, decltype(Material::bsdf)>{"nothing", NullMaterial{}},
        std::pair<const char*, decltype(Material::bsdf)>{"mirror",
                                                         ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), {}}},
        std::pair<const char*, decltype(Material::bsdf)>{"white plastic",
                                                         PlasticMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), true, {}}}));

}  // namespace
}  // namespace treefarm
