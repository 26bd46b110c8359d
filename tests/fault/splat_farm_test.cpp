// SPDX-License-Identifier: Apache-2.0
// Passes whose units are ranges of light paths, and tiles that splat: on any number of workers, whatever happens to
// them, to the same bits.
#include "tests/fault/farm_fixture.h"

namespace treefarm::test {
namespace {

void splat(PassPlan& pass) {
    pass.layers.splats = {kWidth * kHeight, splat_exponent(0.8)};
}

void only_light_paths(PassPlan& pass) {
    splat(pass);
    pass.layers.estimates = pass.units.tiles = false;
    pass.units.light_paths = pass.spp;
    pass.units.first_light_path = pass.first_sample;
    pass.record = false;
}

void only_chains(PassPlan& pass) {
    splat(pass);
    pass.layers.splats.chains = true;
    pass.layers.estimates = pass.units.tiles = false;
    pass.units.chains = 30;
    pass.record = false;
}

void tiles_and_light_paths(PassPlan& pass) {
    splat(pass);
    pass.units.light_paths = 2 * pass.spp;
    pass.units.first_light_path = 2 * pass.first_sample;
}

class SplatFarmTest : public FarmTest {
  protected:
    RenderResult render_with(int workers, unsigned threads) {
        make_workers(workers);
        for (WorkerSettings& settings : settings_)
            settings.threads = threads;
        return render();
    }
};

class Kinds : public SplatFarmTest, public ::testing::WithParamInterface<void (*)(PassPlan&)> {};

TEST_P(Kinds, AnyNumberOfWorkersGivesTheSameBits) {
    std::string image, tree;
    for (const auto& [workers, threads, tile] : {std::tuple{1, 1u, 8}, {2, 2u, 8}, {3, 1u, 5}, {5, 2u, 16}}) {
        channels_.clear();
        faulty_.clear();
        change_pass_ = GetParam();
        job_.farm.tile_size = tile;
        const RenderResult result = render_with(workers, threads);
        if (image.empty()) {
            image = hash_text(result.image_hash);
            tree = hash_text(result.tree_hash);
            double mean = 0;
            for (const Rgb64& pixel : result.image->mean)
                mean += pixel.y / (kWidth * kHeight);
            EXPECT_GT(mean, 0.9);
        }
        EXPECT_EQ(hash_text(result.image_hash), image) << workers << " workers";
        EXPECT_EQ(hash_text(result.tree_hash), tree);
        EXPECT_GT(result.passes.back().splat_bytes, 0u);
        EXPECT_TRUE(orderly_);
    }
    EXPECT_NE(image, hash_text(truth().image_hash));
}

INSTANTIATE_TEST_SUITE_P(SplatFarmTest, Kinds,
                         ::testing::Values(&only_light_paths, &tiles_and_light_paths, &splat, &only_chains));

TEST_F(SplatFarmTest, LightPathsAloneMakeUpTheImage) {
    change_pass_ = only_light_paths;
    const RenderResult result = render_with(2, 1);
    double chi_square = 0;
    for (std::uint32_t p = 0; p < kWidth * kHeight; ++p) {
        const double difference = result.image->mean[p].y - static_cast<double>(splatted_radiance(p).y);
        chi_square += difference * difference / result.image->variance[p].y;
    }
    constexpr double kPixels = kWidth * kHeight;
    EXPECT_NEAR(chi_square, kPixels, 0.1 * kPixels);
    EXPECT_EQ(result.passes.back().splat_caps, SplatCaps{});
    EXPECT_EQ(result.passes.back().stats.paths, result.passes.back().plan.spp * std::uint64_t{kWidth * kHeight});
}

TEST_F(SplatFarmTest, AKilledWorkersSplatsAreMadeAgainAndNoneCountsTwice) {
    change_pass_ = tiles_and_light_paths;
    const std::uint64_t undisturbed = render_with(1, 1).image_hash;
    channels_.clear();
    faulty_.clear();
    make_workers(3);
    settings_[0].silence_seconds = 1.0;
    std::atomic<bool> cut = false;
    // After the first pass, to which all contribute, the others wait until it is gone.
    renderers_[1] = renderers_[2] = [&](const Scene&, const Resolved& job) -> RenderUnit {
        return [&, render = fake_renderer(job)](const PassPlan& pass, auto&... args) {
            for (int k = 0; k < 20'000 && !cut && pass.index > 0; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            render(pass, args...);
        };
    };
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && std::get<Result>(decode(bytes)).pass > 0) cut = faulty_[0]->cut = true;
        return true;
    };
    EXPECT_EQ(render({.gather = 20, .lost = 0.3, .dismiss = 0.5}).image_hash, undisturbed);
    EXPECT_EQ(lost_, std::set<int>{1});
    EXPECT_GT(reissued_ + copied_, 0u);
}

TEST_F(SplatFarmTest, ForgedSplatsAreRefused) {
    change_pass_ = only_light_paths;
    const std::uint64_t undisturbed = render_with(1, 1).image_hash;
    channels_.clear();
    faulty_.clear();
    change_first_result([](Result& result) {
        SplatSums other(SplatShape{kWidth * kHeight + 1, splat_exponent(0.8)});  // a film with one pixel more
        result.splats = other.encode();
    });
    EXPECT_EQ(render().image_hash, undisturbed);
    EXPECT_EQ(lost_, std::set<int>{1});
}

}  // namespace
}  // namespace treefarm::test
