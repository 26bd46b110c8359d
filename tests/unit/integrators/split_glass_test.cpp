// SPDX-License-Identifier: Apache-2.0
// Both ways out of smooth glass where the camera sees it (worker/integrators/path/glass_splits.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"
#include "tests/support/resolved.h"
#include "worker/guides/walks.h"
#include "worker/integrators/path/path_recorder.h"
#include "worker/integrators/path/tile_renderer.h"
#include "worker/shading/fresnel.h"

namespace treefarm {
namespace {

constexpr float kBelow = 5.0f;

/// A pane over a floor that shines at it, under an even sky; seen so narrowly that every ray meets it at one angle.
Scene pane(float cosine, float sky) {
    Scene scene;
    const std::int32_t glass = test::add_material(scene, ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f)});
    test::add_shape(scene, test::quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), glass);
    test::add_shape(scene, test::quad({-50, -1, -50}, {0, 0, 100}, {100, 0, 0}), test::add_diffuse(scene, Rgb(0.0f)),
                    Rgb(kBelow));
    scene.emitters.push_back({ConstantEmitter{Rgb(sky)}, {}});
    const float sine = std::sqrt(1.0f - cosine * cosine);
    scene.camera = test::look_at({-sine, cosine, 0}, Vec3(0.0f), {0, 0, 1}, 1e-4f);
    test::set_film(scene, 16, 16);
    return scene;
}

struct MeanAndVariance {
    double mean, variance;  ///< the variance of one sample
};

MeanAndVariance look(const Scene& scene, bool split) {
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.split_glass = split;
    job.budget.spp = 256;
    const test::LocalRender run = test::render_locally(scene, job);
    MeanAndVariance sum{0, 0};
    for (std::size_t p = 0; p < run.image.mean.size(); ++p) {
        sum.mean += run.image.mean[p].x / static_cast<double>(run.image.mean.size());
        sum.variance += 256 * run.image.variance[p].x / static_cast<double>(run.image.mean.size());
    }
    return sum;
}

/// Fraction that the pane mirrors.
double mirrored(float cosine) {
    const double once = fresnel_dielectric(cosine, 1.5f).reflectance;
    return 2 * once / (1 + once);
}

TEST(SplitGlass, HasNoNoiseWhereBothBranchesAreLikely) {
    const double r = mirrored(0.1f);
    ASSERT_GT(r, 0.25);
    ASSERT_LT(r, 0.9);
    const Scene scene = pane(0.1f, 1.0f);
    const MeanAndVariance split = look(scene, true), tossed = look(scene, false);
    EXPECT_NEAR(split.mean, r + (1 - r) * kBelow, 1e-3);
    EXPECT_LT(split.variance, 1e-5);
    EXPECT_NEAR(tossed.variance, r * (1 - r) * (kBelow - 1) * (kBelow - 1), 0.1);
}

TEST(SplitGlass, FollowsAFaintMirrorImageFourTimesAsOften) {
    const double r = mirrored(0.9f), sky = 50;
    ASSERT_LT(r, 0.1);
    const Scene scene = pane(0.9f, static_cast<float>(sky));
    const MeanAndVariance split = look(scene, true), tossed = look(scene, false);
    const double variance = r * sky * r * sky * (1 - 4 * r) / (4 * r);
    EXPECT_NEAR(split.variance, variance, 0.05 * variance);
    EXPECT_NEAR(split.mean, r * sky + (1 - r) * kBelow, 5 * std::sqrt(variance / (256 * 256)));
    EXPECT_LT(split.variance, 0.3 * tossed.variance);
}

TEST(SplitGlass, ADepthLimitOrAMirrorIsNoReasonToSplit) {
    Scene scene = pane(0.1f, 1.0f);
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.max_depth = 1;
    EXPECT_EQ(test::render_locally(scene, job).image.mean[0].x, 0.0);
    scene.materials[0].bsdf = ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), {}};
    EXPECT_NEAR(look(scene, true).mean, 1.0, 1e-5);
}

TEST(SplitGlass, IsTheSameHoweverTheImageIsCut) {
    // Batches mix paths that are split and others: a ball of glass before the sky.
    Scene scene;
    const std::int32_t glass = test::add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(0.9f), {}});
    test::add_shape(scene, Sphere{Vec3(0.0f), 1.0f}, glass);
    test::add_shape(scene, test::quad({-9, -1, -9}, {0, 0, 18}, {18, 0, 0}), test::add_diffuse(scene, Rgb(0.6f)));
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    scene.camera = test::look_at({0, 0.5f, -4}, Vec3(0.0f), {0, 1, 0}, 0.4f);
    test::set_film(scene, 12, 10);
    const Job job;
    PassPlan pass;
    pass.spp = 70;
    pass.next_event = pass.record = true;
    pass.blocks_per_unit = 64;
    const TraceScene trace(scene, resolve(job, scene));
    const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
    const auto render = [&](const WorkUnit& unit, RecordLog& log) {
        std::vector<PixelEstimate> pixels;
        UnitStats stats;
        test::render_unit(trace, job, pass, guide, unit, pixels, log, stats);
        return pixels;
    };
    RecordLog whole_log, left_log, right_log;
    const std::vector<PixelEstimate> whole = render({0, 0, 0, 12, 10, 0}, whole_log),
                                     left = render({0, 0, 0, 5, 10, 0}, left_log),
                                     right = render({0, 5, 0, 12, 10, 0}, right_log);
    for (std::size_t y = 0; y < 10; ++y)
        for (std::size_t x = 0; x < 12; ++x) {
            const Moments a = whole[y * 12 + x].whole(), b = (x < 5 ? left[y * 5 + x] : right[y * 7 + x - 5]).whole();
            ASSERT_EQ(a.mean, b.mean);
            ASSERT_EQ(a.m2, b.m2);
        }
    EXPECT_EQ(whole_log.records.size(), left_log.records.size() + right_log.records.size());
    EXPECT_GT(whole_log.records.size(), 1000u);
}

TEST(SplitGlass, OnlyGlassHasAnotherBranch) {
    const Vec3 wo = normalize(Vec3(0.6f, 0.0f, 0.8f)), steep = normalize(Vec3(0.9f, 0.0f, 0.3f));
    const BsdfRandom first{0.0f, Vec2(0.5f)};
    const test::PreparedMaterial glass(DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), {}}),
        thin(ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f)}),
        mirror(ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), {}});
    for (const Bsdf* bsdf : {&glass.front(), &glass.back(), &thin.front()}) {
        const Vec3 from = bsdf == &glass.back() ? normalize(Vec3(0.2f, 0.0f, 0.9f)) : wo;
        const BsdfSample up = bsdf->sample(from, first), down = bsdf->other_branch(from, up.wi);
        EXPECT_GT(up.wi.z, 0.0f);
        EXPECT_LT(down.wi.z, 0.0f);
        EXPECT_NEAR(up.pdf + down.pdf, 1.0, 1e-6);
        EXPECT_EQ(bsdf->other_branch(from, down.wi).wi, up.wi);
    }
    EXPECT_EQ(glass.back().other_branch(steep, glass.back().sample(steep, first).wi).pdf, 0.0f) << "total reflection";
    EXPECT_EQ(mirror.front().other_branch(wo, mirror.front().sample(wo, first).wi).pdf, 0.0f);
}

TEST(SplitGlass, NoPathIsLostOnABranchThatIsBlack) {
    const Vec3 wo = normalize(Vec3(0.6f, 0.0f, 0.8f));
    for (const float lobe : {0.0f, 0.5f, 0x1.fffffep-1f}) {
        const test::PreparedMaterial only_mirrors(DielectricMaterial{1.5f, Rgb(1.0f), Rgb(0.0f), {}}),
            only_lets_through(ThinDielectricMaterial{1.5f, Rgb(0.0f), Rgb(1.0f)});
        const BsdfSample up = only_mirrors.front().sample(wo, {lobe, Vec2(0.5f)}),
                         down = only_lets_through.front().sample(wo, {lobe, Vec2(0.5f)});
        EXPECT_EQ(up.pdf, 1.0f);
        EXPECT_FLOAT_EQ(up.f_cos.x, fresnel_dielectric(wo.z, 1.5f).reflectance);
        EXPECT_EQ(down.pdf, 1.0f);
        EXPECT_NEAR(down.f_cos.x, 1 - mirrored(wo.z), 1e-6);
        EXPECT_EQ(only_mirrors.front().other_branch(wo, up.wi).pdf, 0.0f);
        EXPECT_EQ(only_lets_through.front().other_branch(wo, down.wi).pdf, 0.0f);
    }
}

TEST(PathRecorder, AGlassSplitCarriesNothingForTheOtherBranch) {
    PathRecorder<SdTreeWalk<true>> recorder;
    RecordLog log;
    log.begin(2);
    recorder.begin_path();
    recorder.add_delta_vertex(Rgb(0.9f), {}, 0);
    recorder.add_vertex({0}, 11, 0.5f, Rgb(0.5f), {3}, 0);
    recorder.add_emission(Rgb(1.0f));
    EXPECT_EQ(recorder.commit(log), 1u);
    recorder.begin_other_branch(Rgb(0.1f));
    recorder.add_reflected(recorder.vertex_count(), Rgb(100.0f));
    recorder.add_vertex({1}, 22, 4.0f, Rgb(0.25f), {4}, 0);
    recorder.add_emission(Rgb(8.0f));
    EXPECT_EQ(recorder.commit(log), 1u) << "of what was before it nothing is left";
    ASSERT_EQ(log.records.size(), 2u);
    EXPECT_FLOAT_EQ(log.records[0].value, 1.0f / 0.5f);
    EXPECT_FLOAT_EQ(log.records[1].value, 8.0f / 4.0f);
}

/// Facts of a unit's records that do not depend on their order.
using RecordFacts = std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, float, float, int>>;

struct Traced {
    std::vector<PixelEstimate> pixels;
    RecordFacts records;
};

Traced trace(const TraceScene& scene, const Job& job, const PassPlan& pass, const SdTreeSampler& guide,
             const WorkUnit& unit) {
    Traced traced;
    RecordLog log;
    log.begin(guide.distribution_count());
    UnitStats stats;
    test::render_unit(scene, job, pass, guide, unit, traced.pixels, log, stats);
    for (const Record& r : log.records)
        traced.records.emplace_back(r.distribution, r.code, r.rounding, r.value, r.reflected, r.bin);
    return traced;
}

/// Paths take the slots of others that have ended, other ways walk when all the others are done, and there are more
/// than fit into a group.
TEST(PathKernel, APathDoesNotDependOnOthers) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const std::int32_t glass = test::add_material(scene, ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f)});
    test::add_shape(scene, test::quad({0.1f, 0.2f, 0.1f}, {0.7f, 0, 0}, {0, 0.5f, 0.5f}), glass);
    test::set_film(scene, 16, 16);
    Job job;
    job.guiding.type = GuidingType::none;
    PassPlan pass;
    pass.spp = 8;
    pass.next_event = true;
    pass.blocks_per_unit = 64;
    const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
    const TraceScene prepared(scene, resolve(job, scene));
    for (const bool record : {false, true}) {
        pass.record = record;
        Traced together = trace(prepared, job, pass, guide, {pass.index, 0, 0, 16, 16, 0});
        ASSERT_EQ(together.pixels.size(), 256u);
        RecordFacts alone;
        int lit = 0;
        for (std::uint16_t y = 0; y < 16; ++y)
            for (std::uint16_t x = 0; x < 16; ++x) {
                const WorkUnit pixel{pass.index, x, y, std::uint16_t(x + 1), std::uint16_t(y + 1), 0};
                const Traced one = trace(prepared, job, pass, guide, pixel);
                const PixelEstimate &a = together.pixels[y * 16u + x], &b = one.pixels.front();
                for (int half = 0; half < 2; ++half) {
                    ASSERT_EQ(a.half[half].mean, b.half[half].mean) << x << " " << y;
                    ASSERT_EQ(a.half[half].m2, b.half[half].m2);
                }
                lit += a.whole().mean.x > 0;
                alone.insert(alone.end(), one.records.begin(), one.records.end());
            }
        EXPECT_GT(lit, 128);
        EXPECT_EQ(alone.empty(), !record);
        std::sort(alone.begin(), alone.end());
        std::sort(together.records.begin(), together.records.end());
        EXPECT_EQ(together.records, alone);
    }
}

}  // namespace
}  // namespace treefarm
