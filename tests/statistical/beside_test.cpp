// SPDX-License-Identifier: Apache-2.0
// A guide beside another one: what the walk draws and weighs, what it learns, and renders by it. The toy costs one
// file, tests/support/lobe_guide.h, and one line at its end. Laws of both as one guide: guide_laws_test.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "common/math/warp.h"
#include "coordinator/input/load.h"
#include "tests/support/chi_square.h"
#include "tests/support/lobe_guide.h"
#include "tests/support/rendered.h"
#include "tests/support/resolved.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"
#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"
#include "worker/shading/plain_diffuse.h"

namespace treefarm {
namespace {

using TreeBesideGrid = Beside<SdTreeGuide, GridGuide>;
using ThreeGuides = Beside<Beside<SdTreeGuide, GridGuide>, test::LobeGuide>;
static_assert(Guide<TreeBesideGrid> && Guide<test::TreeBesideLobes> && Guide<ThreeGuides>);
static_assert(GuideWalk<WalkOf<ThreeGuides::Sampler>>);
static_assert(ThreeGuides::kMagic != TreeBesideGrid::kMagic && WalkOf<ThreeGuides::Sampler>::List::kFurther == 3);

/// A diffuse surface, without the geometry.
struct BesideSurface {
    static constexpr bool kGeneral = true;
    static bool smooth() { return true; }
    static bool view_dependent() { return false; }
    const PlainDiffuse& bsdf() const { return diffuse; }
    const Frame& frame() const { return shading; }
    const Vec3& wo() const { return outgoing; }

    PlainDiffuse diffuse{Rgb(0.8f), false};
    Frame shading{normalize(Vec3(0.2f, 0.3f, 1.0f))};
    Vec3 outgoing = normalize(Vec3(0.5f, 0.1f, 0.8f));
};

const Vec3 kPlace(0.4f, 0.6f, 0.3f);

/// Directions that a guide's walk draws at kPlace, one at a time.
template <class G>
class BesideDraws {
  public:
    using Walk = WalkOf<typename G::Sampler>;

    explicit BesideDraws(const typename G::Model& model) : guide(model), batch_(new Batch) {
        guidance.region = guide.region(kPlace);
        guidance.bsdf_fraction = guide.trained() ? guide.bsdf_fraction(guidance.region) : 1.0f;
        if constexpr (Walk::kLocal) {
            std::uint32_t code = 0;
            if (guide.trained()) Walk::template localise<true>(guide, surface, kPlace, Vec3(0, 0, 1), code, guidance);
            if (!guide.trained()) Walk::template localise<false>(guide, surface, kPlace, Vec3(0, 0, 1), code, guidance);
        }
    }

    bool draw(std::uint32_t i, std::uint32_t pass, typename Walk::Scatter& s) {
        const Draw random = treefarm::draw({6, i, pass}, 0, Stream::scatter);
        const Vec3 cosine = square_to_cosine_hemisphere({to_unit(random[2]), to_unit(random[3])});
        batch_->clear();
        if (!batch_->draw(surface, guide, guidance, to_unit(random[0]), random, cosine, s)) return false;
        batch_->convert(guide);
        batch_->complete(surface, guide, guidance, s);
        return true;
    }

    float pdf(const Vec3& local, const typename Walk::Direction& direction) const {
        return Walk::pdf(guide, guidance, surface.bsdf().value(surface.wo(), local).pdf, direction);
    }

    BesideSurface surface;
    typename G::Sampler guide;
    typename Walk::Guidance guidance = Walk::unguided();

  private:
    using Batch = typename Walk::template ScatterBatch<true, true>;
    std::unique_ptr<Batch> batch_;
};

FirstModel first_settings() {
    FirstModel settings;
    settings.grid_halvings = 3;
    return settings;
}

/// Model after passes at kPlace that found this light; each pass's sums are merged from parts in random order.
template <class G, class Light>
typename G::Model taught(Light light, std::uint32_t passes) {
    using Draws = BesideDraws<G>;
    using Walk = typename Draws::Walk;
    typename G::Model model = G::first(Box3(Vec3(0.0f), Vec3(1.0f)), first_settings());
    typename G::Learner learner;
    std::mt19937 engine(4);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        Draws draws(model);
        RecordLog log;
        log.begin(draws.guide.distribution_count());
        log.drafts.resize(Walk::kRecordsPerVertex);
        for (std::uint32_t i = 0; i < 60'000; ++i) {
            typename Walk::Scatter s;
            if (!draws.draw(i, pass, s) || !(s.pdf > 0.0f)) continue;
            const float radiance = light(s.world);
            const TaughtDirection<Walk> direction{Walk::direction(s), s.pdf, radiance,
                                                  average(s.f_cos) / s.pdf * radiance, Walk::bins(draws.guidance, s)};
            Record* const end =
                Walk::teach({}, i * 0x9e3779b9u, Walk::target(draws.guidance), direction, log, log.drafts.data());
            log.records.insert(log.records.end(), log.drafts.data(), end);
        }
        CellAccumulator<typename G::Sampler> whole(model.pass, draws.guide, DirectionalFilter::box, pass > 0);
        whole.commit(log.records, log.counts, {});
        const CellSums sums = whole.take();
        std::vector<Record> records(log.records.begin(), log.records.end());
        std::shuffle(records.begin(), records.end(), engine);
        CellSums merged(model.pass, sums.shape());
        for (std::size_t part = 0; part < 3; ++part) {
            CellAccumulator<typename G::Sampler> some(model.pass, draws.guide, DirectionalFilter::box, pass > 0);
            const auto from = std::ptrdiff_t(records.size() * part / 3),
                       to = std::ptrdiff_t(records.size() * (part + 1) / 3);
            const std::vector<std::uint32_t> none(log.counts.size());
            some.commit(std::vector<Record>(records.begin() + from, records.begin() + to),
                        part == 1 ? log.counts : none, {});
            merged.merge_encoded(some.take().encode());
        }
        EXPECT_EQ(merged.encode(), sums.encode());
        RefineReport report;
        model = learner.learn(model, merged, {.spatial_threshold = 1e9}, pass > 0, report);
    }
    return model;
}

const Vec3 kLamp = normalize(Vec3(0.5f, -0.2f, 0.9f));
/// A lamp of the lobe's shape, and little light elsewhere.
float lobe_lamp(const Vec3& d) {
    return 0.02f + std::exp(20 * (dot(d, kLamp) - 1));
}

template <class G>
class BesideWalks : public testing::Test {};
using BesideKinds = testing::Types<TreeBesideGrid, test::TreeBesideLobes, ThreeGuides>;
TYPED_TEST_SUITE(BesideWalks, BesideKinds);

/// All techniques together: chi-square against the density that next event asks for, which is that of the draw itself.
TYPED_TEST(BesideWalks, DirectionsFollowTheMixture) {
    using Draws = BesideDraws<TypeParam>;
    using Walk = typename Draws::Walk;
    for (const std::uint32_t passes : {0u, 1u, 4u}) {
        Draws draws(taught<TypeParam>(lobe_lamp, passes));
        std::array<int, Walk::List::kFurther + 2> drawn_by{};
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            typename Walk::Scatter s;
            if (!draws.draw(i, 99, s)) return false;
            d = s.world;
            if (is_black(s.f_cos)) return false;
            ++drawn_by[s.guided ? 1u + s.technique : 0u];
            EXPECT_EQ(s.pdf, draws.pdf(s.local, Walk::direction(s)));
            return true;
        };
        const auto density = [&](const Vec3& d) {
            const Vec3 local = draws.surface.frame().to_local(d);
            return local.z > 0.0f ? double(draws.pdf(local, Walk::direction_at(direction_to_square(d)))) : 0.0;
        };
        const auto result = test::test_directions(sample, density, 1 << 19, 16, 64);
        EXPECT_NEAR(result.integral, result.success, 3e-3) << passes;
        EXPECT_GT(result.p_value, 1e-4 / 9) << passes;
        if (passes != 1) continue;  // later some may be of no use
        for (std::size_t t = 0; t < drawn_by.size(); ++t)
            EXPECT_EQ(drawn_by[t] > 0, t != 2) << "technique " << t << ": all but the views, of which there are none";
    }
}

/// A technique that fits the light gets most of the samples, and one of no use few; it takes them from the others
/// alike.
TEST(BesideMixture, LearnsWhatEachIsGoodFor) {
    using Pair = Beside<GridGuide, test::LobeGuide>;
    const auto lobe_fraction = [](const BesideDraws<Pair>& draws) {
        return BesideDraws<Pair>::Walk::List::local<BesideTechnique<Pair::Sampler>>(draws.guidance).fraction;
    };
    const Vec3 left = normalize(Vec3(-1.0f, 0.0f, 0.7f)), right = normalize(Vec3(1.0f, 0.0f, 0.7f));
    const auto two_lamps = [&](const Vec3& d) {  // their mean direction is dark
        return 0.01f + std::exp(40 * (dot(d, left) - 1)) + std::exp(40 * (dot(d, right) - 1));
    };
    const BesideDraws<Pair> fits(taught<Pair>(lobe_lamp, 6)), useless(taught<Pair>(two_lamps, 6));
    EXPECT_GT(lobe_fraction(fits), 0.5f);
    EXPECT_LT(lobe_fraction(useless), 0.1f);
    const BesideDraws<GridGuide> alone(taught<GridGuide>(two_lamps, 6));
    EXPECT_NEAR(useless.guidance.bsdf_fraction / (1 - lobe_fraction(useless)), alone.guidance.bsdf_fraction, 0.05f);
}

/// Light in the cells of one guide is not taken for the other's.
TEST(BesideMixture, EachLearnsFromItsOwnCells) {
    using Pair = Beside<GridGuide, test::LobeGuide>;
    const Pair::Model model = Pair::first(Box3(Vec3(0.0f), Vec3(1.0f)), first_settings());
    const Pair::Sampler guide(model);
    const std::uint32_t region = guide.region(kPlace), lobe = guide.beside().region(kPlace);
    const std::uint32_t down = direction_to_code(-kLamp), up = direction_to_code(kLamp);
    CellSums sums = CellAccumulator<Pair::Sampler>(model.pass, guide).take();
    for (const auto& [distribution, code] : {std::pair(region, down), std::pair(guide.first() + lobe, up)}) {
        sums.add_count(distribution, 1000);
        sums.add_quanta(guide.cell(distribution, code), 1'000'000);
    }
    RefineReport report;
    const Pair::Sampler next(Pair::Learner().learn(model, sums, {}, false, report));
    EXPECT_GT(next.pdf(region, down), 2 * next.pdf(region, up));
    EXPECT_GT(next.beside().pdf(lobe, kLamp), 2 * next.beside().pdf(lobe, -kLamp));
}

/// Records of vertices, and of whole paths.
struct PathLog : RecordLog {
    std::vector<std::pair<PathKey, Rgb>> paths;
};

/// A guide's walk that also records whole paths.
template <class Walk>
struct PathTeachingWalk : Walk {
    using Log = PathLog;

    static void teach_path(PathLog& log, const PathKey& key, const Rgb& radiance) {
        log.paths.emplace_back(key, radiance);
    }
};

/// Renders passes of `spp` samples, of which each but the first is guided by what was learned in those before. Mean and
/// variance of the pixels are the last pass's.
template <class G, class Surface>
test::Rendered render_beside(const Scene& scene, const Job& job, std::span<const std::uint32_t> passes) {
    using Walk = PathTeachingWalk<WalkOf<typename G::Sampler>>;
    const TraceScene trace(scene, resolve(job, scene));
    const Resolved resolved = test::resolved(job, trace);
    FirstModel settings;
    settings.with_views = true;
    settings.grid_halvings = 6;
    typename G::Model model = G::first(scene.bounds(), settings);
    typename G::Learner learner;
    test::Rendered image;
    std::uint32_t first_sample = 0;
    for (const std::uint32_t spp : passes) {
        image.mean = image.variance = RgbImage(scene.film.width, scene.film.height);
        const typename G::Sampler guide(model);
        PassPlan pass;
        pass.spp = spp;
        pass.guided = pass.record = true;
        pass.next_event = job.integrator.next_event == NextEvent::always;
        PathLog log;
        log.begin(guide.distribution_count());
        Rgb64 carried(0.0);
        UnitStats stats;
        using Kernel = PathKernel<Walk, Surface, true, true>;
        const auto kernel =
            std::make_unique<Kernel>(trace, guide, PathSettings(trace, resolved, pass, guide), stats, &log);
        for (int y = 0; y < scene.film.height; ++y)
            for (int x = 0; x < scene.film.width; ++x) {
                Rgb64 sum(0.0), squares(0.0);
                for (std::uint32_t sample = 0; sample < spp;) {
                    kernel->clear();
                    for (; !kernel->full() && sample < spp; ++sample) {
                        const PathKey key{job.sampler.seed, trace.film().key_of(x, y), first_sample + sample};
                        kernel->add(key, trace.camera().generate(x, y, key));
                    }
                    kernel->trace();
                    for (std::uint32_t i = 0; i < kernel->count(); ++i) {
                        const Rgb64 value(kernel->radiance(i));
                        sum += value;
                        squares += value * value;
                    }
                }
                const Rgb64 mean = sum / double(spp);
                const std::size_t at = std::size_t(y) * std::size_t(scene.film.width) + std::size_t(x);
                image.mean.pixels[at] = Rgb(mean);
                image.variance.pixels[at] = Rgb((squares / double(spp) - mean * mean) / double(spp - 1));
                carried += sum;
            }
        Rgb64 taught(0.0);
        for (const auto& [key, radiance] : log.paths)
            taught += Rgb64(radiance);
        EXPECT_GE(log.paths.size(), scene.film.pixel_count() * spp);
        EXPECT_NEAR(luminance(taught) / luminance(carried), 1.0, 1e-3) << "each path's radiance is recorded once";
        first_sample += spp;
        CellAccumulator<typename G::Sampler> accumulator(model.pass, guide, DirectionalFilter::box, true);
        accumulator.commit(log.records, log.counts, log.caps);
        RefineReport report;
        model =
            learner.learn(model, accumulator.take(), {.spatial_threshold = 2000, .view_threshold = 1000}, true, report);
    }
    return image;
}

/// Renders by guides beside each other have the image of the reference path tracer.
TEST(BesideRender, AgreesWithTheReference) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 32, 32);
    Job job;
    job.integrator.max_depth = 6;
    job.integrator.type = "reference";
    job.integrator.next_event = NextEvent::always;
    job.budget.spp = 508;
    job.sampler.seed = 1;
    const test::Rendered reference = test::rendered(test::render_locally(scene, job), scene.film);
    job.integrator.type = Job().integrator.type;
    job.sampler.seed = 2;
    const std::uint32_t passes[] = {16, 32, 64, 256};
    for (const NextEvent next_event : {NextEvent::always, NextEvent::never}) {
        job.integrator.next_event = next_event;
        const auto lobes = render_beside<test::TreeBesideLobes, DiffuseSurface>(scene, job, passes);
        test::expect_same_image(lobes, reference, "a tree beside lobes");
    }
    const auto three = render_beside<ThreeGuides, DiffuseSurface>(scene, job, passes);
    test::expect_same_image(three, reference, "a tree, a grid and lobes");
}

/// Glossy and transparent surfaces, with views: four techniques at a vertex.
TEST(BesideRender, AgreesWithTheReferenceOnOtherSurfaces) {
    Scene scene = load_scene(test::own_scene("features.xml"), {}, false, 48, 32).scene;
    Job job;
    job.integrator.max_depth = 8;
    job.integrator.type = "reference";
    job.integrator.next_event = NextEvent::always;
    job.budget.spp = 508;
    job.sampler.seed = 3;
    const test::Rendered reference = test::rendered(test::render_locally(scene, job), scene.film);
    job.integrator.type = Job().integrator.type;
    job.sampler.seed = 4;
    const std::uint32_t passes[] = {8, 16, 32, 64, 256};
    const auto guided = render_beside<TreeBesideGrid, GeneralSurface>(scene, job, passes);
    test::expect_same_image(guided, reference, "a tree with views beside a grid");
}

/// A closed room that emits 1 and reflects half: 2 arrives from everywhere.
TEST(BesideRender, FurnaceHasTheExactMean) {
    const Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    Job job;
    job.integrator.max_depth = 64;
    job.integrator.next_event = NextEvent::never;
    const std::uint32_t passes[] = {64, 128, 1024};
    const test::Rendered image = render_beside<test::TreeBesideLobes, DiffuseSurface>(scene, job, passes);
    double mean = 0, variance = 0;
    for (std::size_t p = 0; p < image.mean.pixels.size(); ++p) {
        mean += double(image.mean.pixels[p].x) / double(image.mean.pixels.size());
        variance += double(image.variance.pixels[p].x) / std::pow(double(image.mean.pixels.size()), 2);
    }
    EXPECT_LT(std::abs(mean - 2.0), 4.0 * std::sqrt(variance) + 1e-5);
}

}  // namespace
}  // namespace treefarm
