// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/resolved.h"
#include "tests/support/test_scenes.h"
#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"
#include "worker/integrators/path/path_recorder.h"
#include "worker/integrators/path/tile_renderer.h"
#include "worker/integrators/subpath/mis.h"
#include "worker/integrators/subpath/roulette.h"

namespace treefarm {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Job unguided() {
    Job job;
    job.guiding.type = GuidingType::none;
    return job;
}

PassPlan one_pass(std::uint32_t spp, bool next_event, bool record = false) {
    PassPlan pass;
    pass.spp = spp;
    pass.next_event = next_event;
    pass.record = record;
    pass.blocks_per_unit = 64;
    return pass;
}

struct Rendered {
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    UnitStats stats;
    Rgb64 mean{0.0};
};

Rendered render(const Scene& scene, const Job& job, const PassPlan& pass) {
    Rendered r;
    const TraceScene trace(scene, resolve(job, scene));
    const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
    const WorkUnit unit{
        pass.index, 0, 0, static_cast<std::uint16_t>(scene.film.width), static_cast<std::uint16_t>(scene.film.height),
        0};
    test::render_unit(trace, job, pass, guide, unit, r.pixels, r.log, r.stats);
    for (const PixelEstimate& p : r.pixels)
        r.mean += p.whole().mean / double(r.pixels.size());
    return r;
}

TEST(Mis, EdgesOfTheRange) {
    for (const MisHeuristic h : {MisHeuristic::balance, MisHeuristic::power}) {
        EXPECT_EQ(mis_weight(h, 1e30f, 1.0f), 1.0f);
        EXPECT_LT(mis_weight(h, 1.0f, 1e30f), 1e-29f);
        EXPECT_EQ(mis_weight(h, kInfinity, 3.0f), 1.0f);
        EXPECT_EQ(mis_weight(h, 3.0f, kInfinity), 0.0f);
        EXPECT_EQ(mis_weight(h, 0.0f, 0.0f), 0.0f);
        EXPECT_EQ(mis_weight(h, 2.0f, 0.0f), 1.0f);
        EXPECT_EQ(mis_weight(h, 2.0f, 2.0f), 0.5f);
        for (const float a : {1e-30f, 0.3f, 7.0f, 1e25f})
            for (const float b : {1e-30f, 0.2f, 7.0f, 1e30f})
                EXPECT_NEAR(mis_weight(h, a, b) + mis_weight(h, b, a), 1.0f, 1e-6f) << a << " " << b;
    }
    EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::balance, 1.0f, 3.0f), 0.25f);
    EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::power, 1.0f, 3.0f), 0.1f);
    EXPECT_EQ(mis_weight(MisHeuristic::equal, 1.0f, 3.0f), 0.5f);
    EXPECT_EQ(mis_weight(MisHeuristic::equal, 1e30f, 1e-30f) + mis_weight(MisHeuristic::equal, 1e-30f, 1e30f), 1.0f);
    for (const float own : {0.0f, 2.0f, kInfinity})
        for (const float other : {0.0f, 2.0f, kInfinity})
            if (own != other) {
                EXPECT_EQ(mis_weight(MisHeuristic::equal, own, other), own > other ? 1.0f : 0.0f);
            }
}

TEST(Roulette, Rules) {
    using Rule = Roulette::Rule;
    EXPECT_FLOAT_EQ(Roulette(Rule::unguided, 5).survival(Rgb(0.1f, 0.3f, 0.2f)), 0.6f);
    EXPECT_FLOAT_EQ(Roulette(Rule::unguided, 5).survival(Rgb(0.1f), 0.5f), 0.1f);
    EXPECT_FLOAT_EQ(Roulette(Rule::unguided, 5).survival(Rgb(0.48f)), 0.95f);
    EXPECT_FLOAT_EQ(Roulette(Rule::unguided, 5).survival(Rgb(2.0f)), 0.95f);
    EXPECT_FLOAT_EQ(Roulette(Rule::untrained, 5).survival(Rgb(0.01f)), 0.1f);
    EXPECT_FLOAT_EQ(Roulette(Rule::untrained, 5).survival(Rgb(2.0f)), 0.99f);
    EXPECT_FLOAT_EQ(Roulette(Rule::constant, 5).survival(Rgb(0.01f)), 0.99f);
    EXPECT_FLOAT_EQ(Roulette(Rule::adjoint, 5).survival(Rgb(0.15f)), 0.6f);
    EXPECT_FLOAT_EQ(Roulette(Rule::adjoint, 5).survival(Rgb(0.1f), 1.0f, 16.0f), 0.95f);
    EXPECT_FLOAT_EQ(Roulette(Rule::adjoint, 5).survival(Rgb(0.15f), 2.0f, 0.5f), 0.6f);
    EXPECT_FLOAT_EQ(Roulette(Rule::adjoint, 5).survival(Rgb(0.0f)), 0.5f);
    EXPECT_FALSE(Roulette(Rule::unguided, 5).plays(4));
    EXPECT_TRUE(Roulette(Rule::unguided, 5).plays(5));
}

TEST(PathRecorder, CarriesRadianceBackwards) {
    PathRecorder<SdTreeWalk<true>> recorder;
    RecordLog log;
    log.begin(3);
    recorder.begin_path();
    recorder.add_reflected(recorder.vertex_count(),
                           Rgb(100.0f));  // next event at the first surface: no direction carries it
    recorder.add_vertex({0}, 11, 0.5f, Rgb(0.5f), {3}, 0);
    recorder.add_emission(Rgb(1.0f));
    recorder.survive(0.5f);
    recorder.add_reflected(recorder.vertex_count(), Rgb(2.0f));
    recorder.add_vertex({2}, 22, 4.0f, Rgb(0.25f), {4}, 0);
    recorder.add_emission(Rgb(8.0f));
    EXPECT_EQ(recorder.commit(log), 2u);
    ASSERT_EQ(log.records.size(), 2u);
    EXPECT_EQ(log.records[0].code, 22u);
    EXPECT_FLOAT_EQ(log.records[0].value, 8.0f / 4.0f);
    EXPECT_EQ(log.records[1].code, 11u);
    EXPECT_FLOAT_EQ(log.records[1].value, (1.0f + (2.0f + 0.25f * 8.0f) / 0.5f) / 0.5f);
    EXPECT_EQ(log.counts, (std::vector<std::uint32_t>{1, 0, 1}));
}

/// beta of what the second vertex's region knows takes the place of what the path found there; the mixture learns from
/// what it found.
TEST(PathRecorder, BootstrapsFromWhatTheNextRegionKnows) {
    for (const float beta : {0.0f, 0.25f, 1.0f}) {
        PathRecorder<SdTreeWalk<true>> recorder({.bootstrap = beta});
        RecordLog log;
        log.begin(3);
        recorder.begin_path();
        recorder.add_vertex({0}, 11, 0.5f, Rgb(0.5f), {3}, 0, 9.0f);
        recorder.add_emission(Rgb(1.0f));
        recorder.survive(0.5f);
        recorder.add_reflected(recorder.vertex_count(), Rgb(2.0f));
        recorder.add_vertex({2}, 22, 4.0f, Rgb(0.25f), {4}, 0, 40.0f);
        recorder.add_emission(Rgb(8.0f));
        recorder.survive(0.25f);
        recorder.add_delta_vertex(Rgb(0.5f), {}, 0);
        recorder.add_emission(Rgb(3.0f));
        recorder.commit(log);
        ASSERT_EQ(log.records.size(), 2u);
        const float second = 8.0f + 0.5f * 3.0f / 0.25f;  // a delta lobe is no region's: what the path found stands
        EXPECT_FLOAT_EQ(log.records[0].value, second / 4.0f) << beta;
        const float carried = (1 - beta) * 0.25f * second + beta * 0.25f * 40.0f;
        EXPECT_FLOAT_EQ(log.records[1].value, (1.0f + (2.0f + carried) / 0.5f) / 0.5f) << beta;
        EXPECT_FLOAT_EQ(log.records[1].reflected, 0.5f * (1.0f + (2.0f + 0.25f * second) / 0.5f)) << beta;
    }
}

/// A region learns its mixture from its view-dependent vertices, too, in a bin of its own.
TEST(PathRecorder, RegionAndViewLearnTheirOwnMixtures) {
    PathRecorder<SdTreeWalk<true>> recorder;
    RecordLog log;
    log.begin(2);
    recorder.begin_path();
    recorder.add_vertex({0, {1}}, 5, 2.0f, Rgb(0.5f), {3, 9}, 0);
    recorder.add_emission(Rgb(4.0f));
    recorder.commit(log);
    ASSERT_EQ(log.records.size(), 2u);
    EXPECT_EQ(log.records[0].distribution, 0u);
    EXPECT_EQ(log.records[0].bin, 3);
    EXPECT_FLOAT_EQ(log.records[0].value, 2.0f);
    EXPECT_EQ(log.records[1].distribution, 1u);
    EXPECT_EQ(log.records[1].bin, 9);
    EXPECT_FLOAT_EQ(log.records[1].value, 2.0f) << "f cos L / p";
    EXPECT_FLOAT_EQ(log.records[0].reflected, 2.0f);
    EXPECT_FLOAT_EQ(log.records[1].reflected, 2.0f);
    EXPECT_EQ(log.counts, (std::vector<std::uint32_t>{1, 1}));
}

TEST(PathRecorder, CountsVerticesWithoutRadiance) {
    PathRecorder<SdTreeWalk<true>> recorder;
    RecordLog log;
    log.begin(1);
    recorder.begin_path();
    recorder.add_vertex({0}, 1, 1.0f, Rgb(1.0f), {0}, 0);
    recorder.add_vertex({0}, 2, 1.0f, Rgb(1.0f), {0}, 0);
    EXPECT_EQ(recorder.commit(log), 2u);
    EXPECT_TRUE(log.records.empty());
    EXPECT_EQ(log.counts[0], 2u);
}

TEST(Path, RecordsHoldTheRadianceOfTheirDirections) {
    // In a furnace all directions of the hemisphere carry 1 / (1 - a), so L / p has the mean 2 pi / (1 - a). In
    // kick-start passes the records of scattering and those of next event share the emission between them.
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    test::set_film(scene, 32, 32);
    Job job;
    job.integrator.rr_depth = 2;
    const double exact = 2.0 * double(kPi) / (1.0 - 0.5);
    for (const NextEvent next_event : {NextEvent::never, NextEvent::kickstart}) {
        job.integrator.next_event = next_event;
        const Rendered r = render(scene, job, one_pass(64, next_event == NextEvent::kickstart, true));
        double sum = 0;
        for (const Record& record : r.log.records)
            sum += static_cast<double>(record.value);
        EXPECT_NEAR(sum / static_cast<double>(r.stats.vertices), exact, 0.04 * exact) << static_cast<int>(next_event);
    }
}

TEST(Path, RouletteIsPlayedByWhatGuides) {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const SdTreeSampler untrained(tree);
    tree.trained = true;
    const SdTreeSampler trained(tree);
    const TraceScene scene(test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f)), {});
    const auto survival = [&](const Job& job, const SdTreeSampler& guide) {
        return PathSettings(scene, test::resolved(job),
                            test::with_kernel(test::resolved(job), one_pass(1, false), guide), guide)
            .roulette.survival(Rgb(0.01f));
    };
    EXPECT_FLOAT_EQ(survival(unguided(), untrained), 0.02f);
    EXPECT_FLOAT_EQ(survival({}, untrained), 0.1f);
    EXPECT_FLOAT_EQ(survival({}, trained), 0.5f);
    Job constant;
    constant.guiding.roulette = GuidingRoulette::constant;
    EXPECT_FLOAT_EQ(survival(constant, trained), 0.99f);
}

TEST(Path, DepthCountsEdges) {
    // Inside a cube that emits 1 and reflects 1/2, paths of d edges see 1 + 1/2 + ... + 1/2^(d-1).
    const Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    Job job = unguided();
    job.integrator.rr_depth = 1000;
    double expected = 0;
    for (int depth = 0; depth <= 6; ++depth) {
        job.integrator.max_depth = depth;
        EXPECT_NEAR(render(scene, job, one_pass(4, false)).mean.x, expected, 1e-5) << depth;
        expected += std::pow(0.5, depth);
    }
}

TEST(Path, HiddenEmittersStillShine) {
    const Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    Job job = unguided();
    job.integrator.rr_depth = 1000;
    job.integrator.max_depth = 3;
    job.integrator.hide_emitters = true;
    EXPECT_NEAR(render(scene, job, one_pass(4, false)).mean.x, 0.5 + 0.25, 1e-5);
    Scene empty;
    empty.camera = scene.camera;
    empty.film = scene.film;
    empty.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    EXPECT_EQ(render(empty, job, one_pass(4, true)).mean.x, 0.0);
    job.integrator.hide_emitters = false;
    EXPECT_EQ(render(empty, job, one_pass(4, true)).mean.x, 1.0);
}

TEST(Path, BlackSurfacesEndPaths) {
    const Scene scene = test::furnace(0.0f, 1.0f, 2.0f, Vec3(0.0f));
    const Rendered r = render(scene, unguided(), one_pass(4, true));
    EXPECT_EQ(r.mean.x, 1.0);
    EXPECT_EQ(r.stats.rays, r.stats.paths);
    EXPECT_EQ(r.stats.shadow_rays, 0u);
}

TEST(Path, StrictNormalsDropDisagreement) {
    // A floor whose shading normal leans far over: half of the directions about it lie below the floor.
    Scene scene;
    Mesh floor = test::quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0});
    floor.normals.assign(4, normalize(Vec3(1, 0.02f, 0)));
    test::add_shape(scene, floor, test::add_diffuse(scene, Rgb(0.5f)));
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    scene.camera = test::look_at(Vec3(5, 5, 0), Vec3(0.0f), Vec3(0, 0, 1), 0.1f);
    test::set_film(scene, 8, 8);
    Job job = unguided();
    for (const bool next_event : {false, true}) {
        job.integrator.strict_normals = false;
        EXPECT_NEAR(render(scene, job, one_pass(256, next_event)).mean.x, 0.5, 0.01);
        job.integrator.strict_normals = true;
        EXPECT_NEAR(render(scene, job, one_pass(256, next_event)).mean.x, 0.25, 0.02);
    }
}

TEST(Path, TheFilmRefusesWhatIsNoRadiance) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -1.0f}) {
        std::get<AreaEmitter>(scene.emitters[0].kind).radiance = Rgb(1.0f, bad, 1.0f);
        Job job = unguided();
        job.guiding.type = GuidingType::ppg;
        const Rendered r = render(scene, job, one_pass(1, false, true));
        EXPECT_EQ(r.stats.invalid_samples, 64u);
        EXPECT_EQ(r.stats.first_invalid.size(), UnitStats::kMaxReported);
        EXPECT_EQ(r.stats.first_invalid[1].x, 1);
        EXPECT_EQ(r.mean.x, 0.0);
        EXPECT_TRUE(r.log.records.empty()) << "what a refused path taught is dropped";
        EXPECT_EQ(r.log.counts[0], 0u);
    }
}

TEST(Path, AUnitDoesNotDependOnHowTheImageIsCut) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 12, 10);
    const Job job = unguided();
    const TraceScene trace(scene, resolve(job, scene));
    const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
    const PassPlan pass = one_pass(70, true);
    const Rendered whole = render(scene, job, pass);
    std::vector<PixelEstimate> part;
    RecordLog log;
    UnitStats stats;
    test::render_unit(trace, job, pass, guide, {0, 5, 3, 9, 10, 0}, part, log, stats);
    ASSERT_EQ(part.size(), 28u);
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Moments a = part[i].whole(), b = whole.pixels[(3 + i / 4) * 12 + 5 + i % 4].whole();
        ASSERT_EQ(a.n, 70u);
        ASSERT_EQ(a.n, b.n);
        ASSERT_EQ(a.mean, b.mean);
        ASSERT_EQ(a.m2, b.m2);
    }
}

TEST(Path, RecordsTeachTheDirectionsOfTheLight) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 16, 16);
    Job job;
    for (const bool next_event : {false, true}) {
        const Rendered r = render(scene, job, one_pass(16, next_event, true));
        EXPECT_EQ(r.stats.records, r.log.counts[0]);
        EXPECT_GT(r.log.records.size(), 100u);
        EXPECT_LT(r.log.records.size(), r.log.counts[0]);
        for (const Record& record : r.log.records) {
            ASSERT_EQ(record.distribution, 0u);
            ASSERT_TRUE(record.value > 0.0f && std::isfinite(record.value));
        }
    }
}

TEST(Path, KickstartRecordsNextEventToo) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 16, 16);
    Job job;
    job.integrator.next_event = NextEvent::always;
    const Rendered always = render(scene, job, one_pass(4, true, true));
    job.integrator.next_event = NextEvent::kickstart;
    const Rendered kickstart = render(scene, job, one_pass(4, true, true));
    EXPECT_EQ(kickstart.mean, always.mean);
    EXPECT_GT(kickstart.log.counts[0], always.log.counts[0]);
    EXPECT_GT(kickstart.log.records.size(), always.log.records.size());
    EXPECT_LE(kickstart.log.counts[0], always.log.counts[0] + kickstart.stats.shadow_rays);
}

TEST(Path, LightsWithoutExtentShineWithoutNextEvent) {
    // A point light of intensity 1 at height 2 above a grey floor: L = 0.5 / pi * I cos / d^2 below it.
    Scene scene;
    test::add_shape(scene, test::quad(Vec3(-9, -9, 0), Vec3(18, 0, 0), Vec3(0, 18, 0)),
                    test::add_diffuse(scene, Rgb(0.5f)));
    scene.emitters.push_back({PointEmitter{Vec3(0, 0, 2), Rgb(1.0f)}, {}});
    scene.camera = test::look_at(Vec3(0, 0, 1), Vec3(0.0f), Vec3(0, 1, 0), 0.01f);
    test::set_film(scene, 4, 4);
    for (const NextEvent next_event : {NextEvent::never, NextEvent::kickstart, NextEvent::always}) {
        Job job = unguided();
        job.integrator.next_event = next_event;
        const Rendered r = render(scene, job, one_pass(4, next_event == NextEvent::always));
        EXPECT_NEAR(r.mean.x, 0.5 / M_PI / 4.0, 1e-5) << static_cast<int>(next_event);
    }
}

TEST(Path, VerticesOutsideTheTreeAreCounted) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    const Job job;
    const TraceScene trace(scene, resolve(job, scene));
    const SdTreeSampler small(initial_tree(Box3(Vec3(-0.5f), Vec3(0.5f)), 1.0f));
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    UnitStats stats;
    test::render_unit(trace, job, one_pass(1, false, true), small, {0, 0, 0, 8, 8, 0}, pixels, log, stats);
    EXPECT_EQ(log.caps.outside_positions, stats.vertices);
    EXPECT_GT(stats.vertices, 0u);
}

TEST(Path, DescriptionTellsTheSamePath) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 1, 1);
    const Job job = unguided();
    const PassPlan pass = one_pass(1, true);
    const Rendered r = render(scene, job, pass);
    const SdTreeSampler guide(initial_tree(scene.bounds(), 1.0f));
    const std::string text = test::describe_sample(TraceScene(scene, resolve(job, scene)), job, pass, guide, 0, 0, 0);
    EXPECT_NE(text.find("depth 1: shape \""), std::string::npos) << text;
    EXPECT_NE(text.find("end: "), std::string::npos) << text;
    std::size_t depths = 0;
    for (std::size_t at = text.find("depth "); at != std::string::npos; at = text.find("depth ", at + 1))
        depths += text.compare(at - 1, 1, "\n") == 0;
    EXPECT_EQ(depths, r.stats.rays) << text;
}

}  // namespace
}  // namespace treefarm
