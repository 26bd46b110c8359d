// SPDX-License-Identifier: Apache-2.0
// Light from both ends where connections are short, grazing or long, at any scale and through any lens.
#include "common/plan/schedule/learning.h"
#include "tests/support/both_ends.h"
#include "tests/support/material_scenes.h"
#include "tests/support/scaled_scene.h"
#include "worker/registry.h"

namespace treefarm {
namespace {

/// ours | Lenses of hardly any size, and any plane of focus
/// Others: densities per area of the lens are infinite where it has none, and of a plane of focus far away overflow.
/// Here: the lens is sampled from both ends alike, so that its area is in no density; film positions in double.
/// Holds: by paths, from the lamps and from both ends, a lens or a slit of 1e-25, focused on any plane from 2^-30 to
/// 2^60 away, has the pinhole's image to the bit; with a slit of a tenth of the room the means agree within 4.5
/// standard errors.
TEST(Connections, LensesOfHardlyAnySize) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 12, 12);
    for (const char* const type : test::kFromAnyEnd) {
        const test::LocalRender pinhole = test::render_by(type, scene, 8, 4);
        for (const float focus : {0x1p-30f, 1.0f, 0x1p60f})
            for (const float slit : {0.0f, 1e-25f}) {
                Scene with_lens = scene;
                for (Vec3* v : {&with_lens.camera.corner, &with_lens.camera.across, &with_lens.camera.down})
                    *v *= focus;
                with_lens.camera.lens_u = Vec3(1e-25f, 0, 0);
                with_lens.camera.lens_v = Vec3(0, slit, 0);
                test::expect_same_bits(test::render_by(type, with_lens, 8, 4), pinhole, 1.0,
                                       type + std::to_string(focus));
            }
    }
    scene.camera.lens_u = Vec3(0.1f, 0, 0);
    test::figure("difference of means through a slit, in standard errors, at most",
                 test::expect_mean_of_paths(scene, 4, 120, "slit", test::hide_emitters));
}

/// A floor and a wall, lit over a ceiling by a lamp beside the floor that leans by so much out of its plane, and by
/// one that stands on it.
Scene lamps_edge_on(float lean) {
    Scene scene;
    const std::int32_t white = test::add_diffuse(scene, Rgb(0.7f), true);
    test::add_shape(scene, test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), white);
    test::add_shape(scene, test::quad({-1, 0, -1}, {0, 2, 0}, {0, 0, 2}), white);
    test::add_shape(scene, test::quad({-1, 2, -1}, {4, 0, 0}, {0, 0, 2}), white);
    test::add_shape(scene, test::quad({1, 0, -1}, {0, 0, 2}, {1, lean, 0}), kNone, Rgb(4.0f));
    test::add_shape(scene, test::quad({0.5f, 0, 1}, {0, 0.2f, 0}, {lean, 0, -2}), kNone, Rgb(4.0f));
    scene.camera = test::look_at({2.5f, 0.9f, -0.3f}, {-0.5f, 0.6f, 0}, {0, 1, 0}, 0.5f);
    test::set_film(scene, 12, 12);
    return scene;
}

/// 8 | Lamps seen edge on
/// Others: cosines of about 0 gave NaN, and light below the horizon (mitsuba2 #32; pbrt-r4 #77).
/// Here: a lamp that is not faced is no sample, a cosine of 0 ends a light path, and weights are quotients in double.
/// Holds: for lamps in the plane of what they light, leaning by 0, 1e-30, +-1e-8 and 1e-4, and one that stands on it:
/// nothing is invalid or capped, and means agree with path tracing's within 4.5 standard errors; what lies in the
/// lamp's plane alone is black.
TEST(Connections, LampsEdgeOn) {
    test::Worst worst;
    for (const float lean : {0.0f, 1e-30f, 1e-8f, -1e-8f, 1e-4f})
        worst.see(test::expect_mean_of_paths(lamps_edge_on(lean), 4, 120, std::to_string(lean)), lean);
    Scene flat = lamps_edge_on(0.0f);
    flat.shapes.erase(flat.shapes.begin() + 1, flat.shapes.begin() + 3);
    flat.shapes.pop_back();
    flat.emitters.pop_back();
    std::get<AreaEmitter>(flat.emitters[0].kind).shape = 1;
    for (const char* const type : test::kFromAnyEnd)
        EXPECT_EQ(test::mean_of(test::render_by(type, flat, 60, 4, test::hide_emitters).image).value, 0.0) << type;
    test::figure("difference of means, in standard errors, at most", worst.value);
}

/// Samples of a film of one pixel, one by one.
class OneByOne {
  public:
    OneByOne(const Scene& scene, const Job& job)
        : job_(resolve(job, scene)),
          render_(prepare(job_, std::make_shared<const TraceScene>(scene, job_))),
          model_(first_model(job_, scene)),
          guide_(model_) {}

    /// The most that a sample brings to its own pixel or by splats.
    double brought(std::uint32_t number) {
        const PassPlan pass = make_pass(job_, 0, number, 1, true);
        output_.begin(guide_, pass.layers.splats);
        render_(pass, guide_, {0, 0, 0, 1, 1, 0}, output_);
        double most = output_.pixels.at(0).whole().mean.x;
        for (const SplatLog::Entry& splat : output_.splats.summed())
            most = std::max(most, std::ldexp(static_cast<double>(splat.moments.sum[0]), pass.layers.splats.exponent));
        return most;
    }

  private:
    Resolved job_;
    RenderUnit render_;
    AnyModel model_;
    AnySampler guide_;
    UnitOutput output_;
};

/// ours | Points that nearly coincide
/// Others: connections over hardly any distance brought 1/d^2 (pbrt-v3 #73; Mitsuba #132: a value of 80,000).
/// Here: densities of all other techniques grow as 1/d^2, too, and weights are quotients of them in double.
/// Holds: in rooms whose walls all shine by 1 and reflect 0.8 - a cube, a slab a thousandth as high as wide, a cube
/// seen from 1e-4 off its corner - a path of k edges brings at most 0.8^(k-1), as by path tracing, in every sample of
/// every technique, by balance and power; the mean is the sum over lengths within 4.5 standard errors.
TEST(Connections, PointsThatNearlyCoincide) {
    constexpr float kAlbedo = 0.8f;
    Scene cube = test::furnace(kAlbedo, 1.0f, 2.0f, Vec3(0.0f)), slab = cube, corner = cube;
    slab.shapes[0].geometry = test::box({-1, -1e-3f, -1}, {1, 1e-3f, 1}, true);
    corner.camera = test::look_at(Vec3(1e-4f - 1.0f), Vec3(0.0f), {0, 1, 0}, 1.0f);
    double spike = 0;
    for (Scene scene : {cube, slab, corner}) {
        test::set_film(scene, 8, 8);
        const test::ImageMean mean = test::mean_of(test::render_by("bidirectional", scene, 250, 4).image);
        EXPECT_NEAR(mean.value, 2.952, 4.5 * mean.error);
        EXPECT_LT(mean.error, 0.05);
        test::set_film(scene, 1, 1);
        for (const auto& [light, camera] : {std::pair(1, 3), {1, 4}, {2, 1}, {2, 2}, {2, 3}, {3, 1}, {3, 2}, {4, 1}}) {
            Job job = test::plain_job(1, light + camera - 1, NextEvent::always);
            job.integrator.type = "bidirectional";
            job.bidirectional.light_subpaths = Rule::always;
            job.bidirectional.techniques = std::to_string(light) + "," + std::to_string(camera);
            OneByOne balance(scene, job);
            job.integrator.mis = MisHeuristic::power;
            OneByOne power(scene, job);
            job.bidirectional.weighted = false;
            OneByOne bare(scene, job);
            const double most = std::pow(double(kAlbedo), light + camera - 2);
            for (std::uint32_t i = 0; i < 1000; ++i) {
                ASSERT_LE(balance.brought(i), most * 1.0001) << job.bidirectional.techniques << " " << i;
                ASSERT_LE(power.brought(i), most * 1.0001) << job.bidirectional.techniques << " " << i;
                spike = std::max(spike, bare.brought(i) / most);
            }
        }
    }
    EXPECT_GT(spike, 100.0) << "nothing was tested";
    test::figure("largest contribution without weights, of what the weighted ones keep to", spike);
}

/// 12 | Light paths in scenes of a millionth and a million of their size
/// Others: offsets and thresholds in scene units (Mitsuba 3 #219, #1871; three-gpu #812).
/// Here: densities are in double, bounded far from its ends; quanta of splats follow the scene.
/// Holds: rooms with diffuse walls, and with metal, glass, plastic and a lens, scaled by 2^20 and 2^-20, have the same
/// bits in every pixel's mean and variance, from the lamps and from both ends, by balance and power.
TEST(Connections, ScaledByAMillion) {
    int pixels = 0;
    for (const Scene& scene : test::rooms_to_scale())
        for (const char* const type : test::kFromLamps)
            for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power}) {
                const auto by = [&](Job& job) { job.integrator.mis = mis; };
                const test::LocalRender here = test::render_by(type, scene, 8, 6, by);
                for (const float factor : {0x1p20f, 0x1p-20f}) {
                    test::expect_same_bits(here, test::render_by(type, test::scaled(scene, factor), 8, 6, by), 1.0,
                                           type);
                    pixels += 144;
                }
            }
    test::figure("pixels with the same bits in mean and variance", pixels);
}

/// ours | Long chains of mirrors and glass, from both ends
/// Others: ratios of densities along long chains overflowed, and weights became inf/inf (pbrt 83d4c269).
/// Here: sums over techniques are recursive quotients, bounded at 1e150; of delta lobes no density is in them.
/// Holds: six panes of glass, one of them rough by 1e-3, a mirror and one rough by 1e-4, which lose nothing, are
/// invisible in a room where everything carries 2: with paths of up to 80 edges the mean is 2 within 4.5 standard
/// errors, by balance and power.
TEST(Connections, LongChains) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    const Rgb white(1.0f);
    const auto rough = [](float alpha) { return test::rough(Microfacets::ggx, alpha, alpha); };
    const std::int32_t glass = test::add_material(scene, DielectricMaterial{1.5f, white, white, {}}),
                       frosted = test::add_material(scene, DielectricMaterial{1.5f, white, white, rough(1e-3f)}),
                       mirror = test::add_material(scene, ConductorMaterial{Rgb(0.0f), white, white, {}}, true),
                       metal =
                           test::add_material(scene, ConductorMaterial{Rgb(0.0f), white, white, rough(1e-4f)}, true);
    for (int i = 0; i < 6; ++i) {
        const float z = 0.1f * static_cast<float>(i) - 0.3f;
        test::add_shape(scene, test::box({-0.6f, -0.6f, z}, {0.6f, 0.6f, z + 0.05f}, false), i == 2 ? frosted : glass);
    }
    test::add_shape(scene, test::quad({-0.7f, -0.5f, -0.9f}, {0, 0, 1.6f}, {0, 1, 0.1f}), mirror);
    test::add_shape(scene, test::quad({0.7f, -0.5f, -0.9f}, {0, 1, 0}, {0.1f, 0, 1.6f}), metal);
    scene.camera = test::look_at({0.1f, 0.1f, -0.8f}, {0.0f, 0.0f, 0.4f}, {0, 1, 0}, 0.8f);
    test::set_film(scene, 10, 10);
    test::Worst worst;
    for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power}) {
        const test::LocalRender run = test::render_by("bidirectional", scene, 60, 80, [&](Job& job) {
            job.integrator.mis = mis;
            job.integrator.rr_depth = 12;
        });
        EXPECT_EQ(test::invalid_samples(run), 0u);
        EXPECT_EQ(run.splat_caps, SplatCaps{});
        const test::ImageMean mean = test::mean_of(run.image);
        EXPECT_NEAR(mean.value, 2.0, 4.5 * mean.error);
        EXPECT_LT(mean.error, 0.02);
        worst.see(std::abs(mean.value / 2.0 - 1.0), int(mis));
    }
    test::figure("largest relative error of the mean", worst.value);
}

}  // namespace
}  // namespace treefarm
