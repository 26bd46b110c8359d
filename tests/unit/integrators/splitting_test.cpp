// SPDX-License-Identifier: Apache-2.0
// Paths that go on as several (worker/integrators/path/split_paths.h).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "common/decide/splitting/splitting_gain.h"
#include "coordinator/input/load.h"
#include "tests/support/local_render.h"
#include "tests/support/resolved.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"
#include "worker/integrators/path/path_roulette.h"
#include "worker/integrators/path/split_paths.h"
#include "worker/integrators/path/tile_renderer.h"
#include "worker/integrators/subpath/roulette.h"

namespace treefarm {
namespace {

TEST(Splitting, IsByWhatAPathIsExpectedToCarry) {
    using Rule = Roulette::Rule;
    const Roulette adjoint(Rule::adjoint, 5);
    EXPECT_EQ(adjoint.splitting(Rgb(1.0f), 1.0f, 1.0f, 8), 1u);
    EXPECT_EQ(adjoint.splitting(Rgb(0.1f, 2.7f, 0.1f), 1.0f, 1.0f, 8), 1u);
    EXPECT_EQ(adjoint.splitting(Rgb(0.1f, 2.9f, 0.1f), 1.0f, 1.0f, 8), 2u);
    EXPECT_EQ(adjoint.splitting(Rgb(0.5f), 2.0f, 6.0f, 8), 4u);
    EXPECT_EQ(adjoint.splitting(Rgb(1e30f), 1e6f, 0x1p60f, 8), 8u);
    EXPECT_EQ(adjoint.splitting(Rgb(std::numeric_limits<float>::infinity()), 1.0f, 1.0f, 8), 8u);
    EXPECT_EQ(adjoint.splitting(Rgb(std::numeric_limits<float>::quiet_NaN()), 1.0f, 1.0f, 8), 1u);
    for (const Rule rule : {Rule::unguided, Rule::untrained, Rule::constant})
        EXPECT_EQ(Roulette(rule, 5).splitting(Rgb(100.0f), 1.0f, 1.0f, 8), 1u);
}

/// Every path splits as often as it may: into `ways` each time.
std::uint32_t most_split_paths(SplitBudget budget, std::uint32_t ways) {
    const std::uint32_t paths = budget.split(ways);
    return paths == 1 ? 0 : paths - 1 + paths * most_split_paths(budget, ways);
}

TEST(Splitting, LightIsTheRootOfSquaredRecords) {
    EXPECT_EQ(radiance_exponent(6, GuidingTarget::radiance), 6);
    EXPECT_EQ(radiance_exponent(-40, GuidingTarget::radiance), -40);
    EXPECT_EQ(radiance_exponent(6, GuidingTarget::variance), 3);
    EXPECT_EQ(radiance_exponent(-40, GuidingTarget::variance), -20);
}

TEST(Splitting, SplitPathsAreBounded) {
    EXPECT_EQ(SplitBudget{}.split(1), 1u);
    for (std::uint32_t ways = 2; ways <= 40; ++ways) {
        const std::uint32_t split_paths = most_split_paths({}, ways);
        EXPECT_GE(split_paths, std::min<std::uint32_t>(ways - 1, SplitBudget::kMost));
        EXPECT_LE(split_paths, std::uint32_t{SplitBudget::kMost}) << ways;
    }
    SplitBudget spent;
    spent.left = 0;
    EXPECT_EQ(spent.split(8), 1u);
}

SplitPath split_path_of(std::uint16_t origin, std::uint8_t left_by, int depth) {
    SplitPath split{};
    split.origin = origin;
    split.split_budget.number = left_by;
    split.depth = depth;
    return split;
}

TEST(Splitting, SplitPathsAreNumberedWhateverElseWalks) {
    // Path 1 left two; then, with another path between, its split paths 1 and 2 left some in the other order.
    std::vector<std::uint8_t> numbers(3, 0);
    SplitPaths split_paths;
    split_paths.leave(split_path_of(1, 0, 3));
    split_paths.leave(split_path_of(0, 0, 2));
    split_paths.leave(split_path_of(1, 0, 5));
    const auto first = split_paths.next(numbers);
    ASSERT_EQ(first.size(), 3u);
    EXPECT_EQ(first[0].origin, 0);
    EXPECT_EQ(first[1].depth, 3);
    EXPECT_EQ(first[1].split_budget.number, 1);
    EXPECT_EQ(first[2].depth, 5);
    EXPECT_EQ(first[2].split_budget.number, 2);
    EXPECT_TRUE(split_paths.empty());
    std::map<int, int> alone;
    for (const bool among_others : {false, true}) {
        std::fill(numbers.begin(), numbers.end(), std::uint8_t{2});
        if (among_others) split_paths.leave(split_path_of(2, 1, 9));
        if (among_others) split_paths.leave(split_path_of(1, 2, 7));
        split_paths.leave(split_path_of(1, 1, 4));
        if (among_others) split_paths.leave(split_path_of(0, 1, 9));
        split_paths.leave(split_path_of(1, 1, 6));
        if (!among_others) split_paths.leave(split_path_of(1, 2, 7));
        std::map<int, int> number_of;
        for (const SplitPath& split : split_paths.next(numbers))
            if (split.origin == 1) number_of[split.depth] = split.split_budget.number;
        if (!among_others) alone = number_of;
        EXPECT_EQ(number_of, alone);
    }
    EXPECT_EQ(alone, (std::map<int, int>{{4, 3}, {6, 4}, {7, 5}}));
}

TEST(Splitting, RandomNumbersOfSplitPathsAreTheirOwn) {
    SplitPath split = split_path_of(0, 1, 7);
    EXPECT_EQ(split.first_vertex(), (1u << 16) + 6);
    split.split_budget.number = SplitBudget::kMost;
    EXPECT_LT(split.first_vertex() + (1u << 16), 1u << 28) << "below those of the other way out of glass";
}

class SplittingInARoom : public ::testing::Test {
  protected:
    SplittingInARoom() {
        scene_ = load_scene(test::own_scene("door-ajar.xml"), {}, false).scene;
        scene_.film.width = 24;
        scene_.film.height = 16;
        job_.budget.spp = 31;
        job_.guiding.spatial_threshold = 200;
        job_.guiding.splitting = 32;
        tree_ = test::render_locally(scene_, job_).tree();
        pass_.spp = 96;
        pass_.blocks_per_unit = 64;
        pass_.next_event = true;
        pass_.guided = true;
        pass_.record = true;
    }

    struct Rendered {
        std::vector<PixelEstimate> pixels;
        RecordLog log;
        UnitStats stats;
    };

    Rendered render(const Job& job, const WorkUnit& unit) const {
        Rendered r;
        const TraceScene trace(scene_, resolve(job, scene_));
        test::render_unit(trace, job, pass_, SdTreeSampler(tree_), unit, r.pixels, r.log, r.stats);
        return r;
    }

    WorkUnit part(int x0, int y0, int x1, int y1) const {
        return {pass_.index,
                static_cast<std::uint16_t>(x0),
                static_cast<std::uint16_t>(y0),
                static_cast<std::uint16_t>(x1),
                static_cast<std::uint16_t>(y1),
                0};
    }

    Scene scene_;
    Job job_;
    SdTree tree_;
    PassPlan pass_;
};

/// Groups, batches of split paths and their order differ; samples and what they teach do not.
TEST_F(SplittingInARoom, DoesNotDependOnOtherPaths) {
    const Rendered whole = render(job_, part(0, 0, 24, 16));
    Job alone = job_;
    alone.guiding.splitting = 1;
    EXPECT_GT(whole.stats.rays, render(alone, part(0, 0, 24, 16)).stats.rays * 21 / 20) << "the test must split paths";
    std::uint64_t records = 0;
    UnitStats stats;
    std::vector<std::uint32_t> counts(whole.log.counts.size());
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; x += y % 2 ? 1 : 8) {
            const int end = y % 2 ? x + 1 : x + 8;
            const Rendered r = render(job_, part(x, y, end, y + 1));
            for (int i = x; i < end; ++i) {
                const PixelEstimate &a = r.pixels[static_cast<std::size_t>(i - x)],
                                    &b = whole.pixels[static_cast<std::size_t>(y * 24 + i)];
                ASSERT_EQ(a.whole().mean.x, b.whole().mean.x) << i << ", " << y;
                ASSERT_EQ(a.whole().mean.z, b.whole().mean.z) << i << ", " << y;
            }
            stats.add(r.stats);
            records += r.log.records.size();
            for (std::size_t k = 0; k < counts.size(); ++k)
                counts[k] += r.log.counts[k];
        }
    EXPECT_EQ(stats.rays, whole.stats.rays);
    EXPECT_EQ(stats.split_path_rays, whole.stats.split_path_rays);
    EXPECT_EQ(stats.sums<SplittingSums>().split_mean, whole.stats.sums<SplittingSums>().split_mean);
    EXPECT_EQ(stats.sums<SplittingSums>().unsplit_mean, whole.stats.sums<SplittingSums>().unsplit_mean);
    EXPECT_EQ(stats.sums<SplittingSums>().split_variance, whole.stats.sums<SplittingSums>().split_variance);
    EXPECT_EQ(stats.sums<SplittingSums>().unsplit_variance, whole.stats.sums<SplittingSums>().unsplit_variance);
    EXPECT_EQ(records, whole.log.records.size());
    EXPECT_EQ(counts, whole.log.counts);
}

/// The unsplit samples that paths tell of are those of paths where none is split.
TEST_F(SplittingInARoom, UnsplitSamplesAreThoseOfPathsThatAreNotSplit) {
    pass_.spp = 1024;  // rare samples make most of the noise
    const Rendered split = render(job_, part(0, 0, 24, 16));
    const SplittingGain gain = splitting_gain(split.stats.sums<SplittingSums>(), split.stats);
    EXPECT_NEAR(gain.mean_ratio, 1, 0.1);
    EXPECT_GT(gain.variance, 1.1);
    EXPECT_GT(gain.rays, 1.05);
    Job alone = job_;
    alone.guiding.splitting = 1;
    const Rendered unsplit = render(alone, part(0, 0, 24, 16));
    EXPECT_EQ(unsplit.stats.split_path_rays, 0u);
    EXPECT_EQ(splitting_gain(unsplit.stats.sums<SplittingSums>(), unsplit.stats).variance, 0) << "nothing to compare";
    double with = 0, without = 0;
    for (std::size_t p = 0; p < split.pixels.size(); ++p) {
        // Relative, as passes compare: to the pixel's light here, to what its first region expects there.
        const Moments a = split.pixels[p].whole(), b = unsplit.pixels[p].whole();
        const double light = luminance(a.mean) + luminance(b.mean);
        if (light == 0) continue;
        with += luminance(a.sample_variance()) / (light * light);
        without += luminance(b.sample_variance()) / (light * light);
    }
    EXPECT_NEAR(gain.variance, without / with, 0.35 * without / with);
}

TEST_F(SplittingInARoom, IsToldByDescribeSample) {
    const TraceScene trace(scene_, resolve(job_, scene_));
    const SdTreeSampler guide(tree_);
    for (std::uint32_t sample = 0; sample < pass_.spp; ++sample) {
        const std::string text = test::describe_sample(trace, job_, pass_, guide, 12, 8, sample);
        if (text.find("splits into") == std::string::npos) continue;
        EXPECT_NE(text.find("copy 1 from depth"), std::string::npos) << text;
        return;
    }
    FAIL() << "no sample was split";
}

/// In a furnace whose directions the BSDF alone draws every path carries exactly 1 + a + a^2 + ...: shares that did not
/// sum to one would show in each sample, which z-tests of noisy rooms cannot tell.
TEST(Splitting, FractionsSumToOne) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    test::set_film(scene, 16, 16);
    Job job;
    job.integrator.rr_depth = 1000;
    job.integrator.max_depth = 6;
    job.guiding.candidates = 1;
    job.guiding.splitting = 8;
    job.guiding.spatial_threshold = 50;
    job.guiding.type = GuidingType::view;  // to the end
    job.budget.spp = 31;
    SdTree tree = test::render_locally(scene, job).tree();
    ASSERT_GT(tree.region_count(), 4u);
    for (std::uint32_t r = 0; r < tree.region_count(); ++r) {
        tree.bsdf_fraction[r] = 1.0f;
        tree.quantum_exponent[r] = static_cast<std::int16_t>(tree.quantum_exponent[r] + static_cast<int>(r % 5));
    }
    PassPlan pass;
    pass.spp = 16;
    pass.blocks_per_unit = 64;
    pass.guided = true;
    pass.record = true;
    pass.next_event = false;
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    UnitStats stats;
    test::render_unit(TraceScene(scene, resolve(job, scene)), job, pass, SdTreeSampler(tree),
                      {pass.index, 0, 0, 16, 16, 0}, pixels, log, stats);
    EXPECT_GT(stats.rays, 6 * stats.paths + stats.paths / 2) << "the test must split paths: of six edges each";
    const SplittingGain gain = splitting_gain(stats.sums<SplittingSums>(), stats);
    EXPECT_NEAR(gain.mean_ratio, 1, 1e-6) << "alone they carry the same";
    EXPECT_NEAR(gain.variance, 1, 1e-6) << "of pixels across regions, whose scales differ";
    EXPECT_EQ(stats.rays - stats.split_path_rays, 6 * stats.paths);
    for (const PixelEstimate& pixel : pixels) {
        EXPECT_NEAR(pixel.whole().mean.x, 2 - std::pow(0.5, 5), 1e-5);
        EXPECT_NEAR(pixel.whole().sample_variance().x, 0, 1e-10);
    }
}

}  // namespace
}  // namespace treefarm
