#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"
#include "worker/integrator/tile_renderer.h"

namespace treefarm {
namespace {

struct Place {
    float scale;
    Vec3 offset;  ///< in units of `scale`
};

const Place kPlaces[] = {{1e-4f, Vec3(0.0f)},
                         {1e5f, Vec3(0.0f)},
                         {1.0f, Vec3(1000.0f, -700.0f, 300.0f)},
                         {1e-4f, Vec3(-300.0f, 1000.0f, 800.0f)},
                         {1e5f, Vec3(1000.0f, 1000.0f, 1000.0f)}};

std::vector<PixelEstimate> render(const Scene& scene, const Job& job, std::uint32_t spp, bool next_event) {
    const TraceScene trace(scene, job);
    const Guide guide(initial_tree(scene.bounds(), 1.0f));
    PassPlan pass;
    pass.spp = spp;
    pass.next_event = next_event;
    pass.blocks_per_unit = 64;
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    TraceStats stats;
    render_unit(
        trace, job, pass, guide,
        {0, 0, 0, static_cast<std::uint16_t>(scene.film.width), static_cast<std::uint16_t>(scene.film.height), 0},
        pixels, log, stats);
    EXPECT_EQ(stats.invalid_samples, 0u);
    return pixels;
}

Job unguided() {
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.rr_depth = 1000;
    return job;
}

double mean(const std::vector<PixelEstimate>& pixels) {
    double sum = 0;
    for (const PixelEstimate& p : pixels)
        sum += p.whole().mean.x;
    return sum / static_cast<double>(pixels.size());
}

class Scale : public testing::TestWithParam<Place> {};

/// Without roulette every path of the furnace has the same value, so that even one leak shows.
TEST_P(Scale, FurnaceDoesNotLeak) {
    const Place& place = GetParam();
    Job job = unguided();
    job.integrator.max_depth = 20;
    double exact = 0;
    for (int k = 0; k < 20; ++k)
        exact += std::pow(0.8, k);
    Scene scene = test::furnace(0.8f, 1.0f, place.scale, place.offset * place.scale);
    test::set_film(scene, 32, 32);
    // Moved by 1000 sizes, positions are exact to 6e-5 of the room only: of 20 bounces, some meet an edge that close.
    const double tolerance = place.offset.length() > 1.0f ? 2e-3 : 1e-5;
    EXPECT_NEAR(mean(render(scene, job, 64, false)) / exact, 1.0, tolerance);
}

TEST_P(Scale, CornellBoxLooksTheSame) {
    const Place& place = GetParam();
    Job job = unguided();
    job.integrator.max_depth = 6;
    const auto image = [&](float scale, const Vec3& offset) {
        Scene scene = test::cornell_box(scale, offset);
        test::set_film(scene, 32, 32);
        return render(scene, job, 64, true);
    };
    const auto here = image(1.0f, Vec3(0.0f)), there = image(place.scale, place.offset * place.scale);
    EXPECT_NEAR(mean(there) / mean(here), 1.0, 0.01);
    int different = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        const Moments a = here[i].whole(), b = there[i].whole();
        const double noise = std::sqrt((a.sample_variance().x + b.sample_variance().x) / 64);
        different += std::abs(a.mean.x - b.mean.x) > 4 * noise + 1e-3;
    }
    EXPECT_LE(different, 5) << "pixels beyond their noise";
}

INSTANTIATE_TEST_SUITE_P(Places, Scale, testing::ValuesIn(kPlaces));

TEST(ScaleByTwo, PowersOfTwoAreTheSameBits) {
    Job job = unguided();
    job.integrator.max_depth = 5;
    const auto image = [&](float scale) {
        Scene scene = test::cornell_box(scale, Vec3(0.0f));
        test::set_film(scene, 16, 16);
        return render(scene, job, 16, true);
    };
    const auto a = image(1.0f), b = image(1024.0f);
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ(a[i].whole().mean, b[i].whole().mean) << i;
}

}  // namespace
}  // namespace treefarm
