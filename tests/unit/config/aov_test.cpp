// SPDX-License-Identifier: Apache-2.0
// Layers besides colour: their names, how they merge, and what a job says of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/base/error.h"
#include "common/config/aov_list.h"
#include "common/config/check_job.h"
#include "common/config/estimators.h"
#include "common/config/job_reader.h"
#include "common/film/aov_film.h"
#include "common/plan/forecast/memory.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

std::vector<AovRequest> requests(const std::string& text) {
    std::string why;
    const std::vector<AovRequest> list = parse_aovs(text, why);
    EXPECT_EQ(why, "") << text;
    return list;
}

std::string refusal(const std::string& text) {
    std::string why;
    EXPECT_TRUE(parse_aovs(text, why).empty()) << text;
    return why;
}

TEST(AovList, EveryNameIsReadAndEveryLayerHasItsChannels) {
    for (const AovKind& kind : aov_kinds()) {
        EXPECT_EQ(kind_of(kind.aov).name, kind.name);
        const auto list = requests(kind.name);
        ASSERT_EQ(list.size(), 1u);
        EXPECT_EQ(list[0].aov, kind.aov);
        EXPECT_EQ(aov_text(list[0]), kind.name);
    }
    EXPECT_EQ(requests("albedo")[0].channels(), (std::vector<std::string>{"albedo.R", "albedo.G", "albedo.B"}));
    EXPECT_EQ(requests("depth")[0].channels(), (std::vector<std::string>{"depth.Z"}));
    EXPECT_EQ(requests("alpha")[0].channels(), (std::vector<std::string>{"A"}));
    EXPECT_EQ(requests("glass:alpha")[0].channels(), (std::vector<std::string>{"glass.A"}));
    EXPECT_EQ(requests(" dd.y : depth ,uv")[0].channels(), (std::vector<std::string>{"dd.y.Z"}));
    EXPECT_TRUE(requests("").empty());
}

TEST(AovList, SaysWhatIsWrong) {
    EXPECT_NE(refusal("albedo,nromal").find("did you mean normal?"), std::string::npos);
    EXPECT_NE(refusal("depth,near:depth,depth").find("depth.Z is asked for twice"), std::string::npos);
    EXPECT_NE(refusal("variance:albedo").find("in any case"), std::string::npos);
    EXPECT_NE(refusal("a b:albedo").find("no name of a layer"), std::string::npos);
    EXPECT_NE(refusal("albedo,").find("there is no AOV"), std::string::npos);
}

TEST(AovList, IsAListOfAJob) {
    Job job;
    apply_layer(job, parse_job_settings("[output]\naovs = [\"albedo\", \"n:normal\"]\nhalf = true\n", "job.toml"));
    EXPECT_EQ(job.output.aovs, "albedo,n:normal");
    Job back;
    apply_layer(back, parse_job_settings(write_job(job), "back.toml"));
    EXPECT_EQ(back.output.aovs, job.output.aovs);
    EXPECT_TRUE(back.output.half);
    apply_layer(back, std::vector<Setting>{parse_set_argument("output.aovs=")});
    EXPECT_TRUE(aov_requests(back).empty());
    try {
        apply_layer(job, parse_job_settings("[output]\naovs = [\"albdo\"]\n", "job.toml"));
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("job.toml:2:8"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("did you mean albedo?"), std::string::npos) << error.what();
    }
    EXPECT_THROW(parse_job_settings("[output]\naovs = [1]\n", "job.toml"), InputError);
}

/// Numbers of a block: sums that do not add up exactly in another order, and ids.
std::vector<double> make_block(const AovLayout& layout, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<double> block(layout.size());
    for (double& value : block)
        value = uniform(random);
    for (std::size_t i = layout.id_begin(); i < block.size(); ++i)
        block[i] = static_cast<double>(random() % 100);
    return block;
}

TEST(AovFilm, IsTheSameForAnyOrderAndCut) {
    constexpr int kWidth = 7, kHeight = 5;
    constexpr std::uint32_t kBlocks = 12;
    const AovLayout layout(requests("albedo,depth,material"));
    ASSERT_EQ(layout.size(), 1u + 3 + 1 + 1);
    std::mt19937 random(1);
    std::vector<std::vector<double>> truth(kWidth * kHeight);  // blocks of each pixel
    std::vector<double> whole;
    for (std::vector<double>& blocks : truth) {
        for (std::uint32_t b = 0; b < kBlocks; ++b) {
            const std::vector<double> block = make_block(layout, random);
            blocks.insert(blocks.end(), block.begin(), block.end());
        }
        std::vector<double> reduced = blocks;
        reduce_aov_blocks(layout, reduced);
        EXPECT_EQ(reduced[layout.at(Aov::material)], blocks[layout.at(Aov::material)]) << "the first counts";
        whole.insert(whole.end(), reduced.begin(), reduced.begin() + layout.size());
    }
    for (const std::uint32_t per_unit : {1u, 4u, 16u})
        for (const int step : {2, 3, 7}) {
            const std::uint32_t chunks = (kBlocks + per_unit - 1) / per_unit;
            std::vector<WorkUnit> units = cut_tiles(0, chunks, kWidth, kHeight, step);
            std::shuffle(units.begin(), units.end(), random);
            AovFilm film(layout, kWidth, kHeight, chunks);
            for (const WorkUnit& unit : units) {
                AovPixels part;
                for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
                    for (std::uint32_t x = unit.x0; x < unit.x1; ++x) {
                        const std::vector<double>& blocks = truth[y * kWidth + x];
                        const std::size_t begin = per_unit * unit.chunk * layout.size();
                        const std::size_t end = std::min(begin + per_unit * layout.size(), blocks.size());
                        std::vector<double> some(blocks.begin() + std::ptrdiff_t(begin),
                                                 blocks.begin() + std::ptrdiff_t(end));
                        reduce_aov_blocks(layout, some);
                        part.values.insert(part.values.end(), some.begin(), some.begin() + layout.size());
                    }
                film.check(unit, part, kBlocks * kBlockSamples, false);
                film.add(unit, part);
            }
            EXPECT_EQ(film.take().values, whole) << per_unit << " blocks a unit, tiles of " << step;
        }
}

TEST(AovFilm, RefusesWhatCannotBe) {
    const WorkUnit unit{0, 0, 0, 2, 1, 0};
    const AovFilm film(AovLayout(requests("normal,direct")), 2, 1, 1);
    AovPixels good{std::vector<double>(6, 0.5), std::vector<PixelEstimate>(2)};
    EXPECT_NO_THROW(film.check(unit, good, 1, false));
    AovPixels bad = good;
    bad.values.pop_back();
    EXPECT_THROW(film.check(unit, bad, 1, false), FormatError);
    bad = good;
    bad.direct.clear();
    EXPECT_THROW(film.check(unit, bad, 1, false), FormatError);
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
        bad = good;
        bad.values[3] = value;
        EXPECT_THROW(film.check(unit, bad, 1, false), FormatError) << value;
        bad = good;
        bad.direct[1].half[0].mean.y = value;
        EXPECT_THROW(film.check(unit, bad, 1, false), FormatError) << value;
        if (std::isfinite(value)) continue;
        bad = good;
        bad.direct[0].half[1].m2.z = value;
        EXPECT_THROW(film.check(unit, bad, 1, false), FormatError) << value;
    }
    EXPECT_THROW(AovFilm(AovLayout(), 2, 1, 1).check(unit, good, 1, false), FormatError) << "nobody asked";
}

TEST(AovSums, MeansAreOfAllPassesAndNumbersOfTheFirst) {
    const std::vector<AovRequest> asked = requests("alpha,depth,shape,direct,indirect,spp");
    AovSums sums(asked, 2);
    const AovLayout layout(asked);
    ASSERT_EQ(layout.size(), 3u);
    const auto estimate = [](float value, std::uint32_t spp) {
        PixelEstimate pixel;
        for (std::uint32_t s = 0; s < spp; ++s)
            pixel.add(s, Rgb(value));
        return pixel;
    };
    // Pixel 0: 2 + 3 of 2 + 6 samples meet something at depths of 10 in all; pixel 1 sees nothing.
    sums.add({{2, 8, 7, 0, 0, 0}, {estimate(1.0f, 2), estimate(0.0f, 2)}}, 2);
    sums.add({{3, 2, 9, 0, 0, 5}, {estimate(3.0f, 6), estimate(0.0f, 6)}}, 6);
    CombinedImage image;
    image.mean = {Rgb64(4.0), Rgb64(0.25)};
    std::vector<PassResult> passes(2);
    passes[0].pixels = {estimate(0.0f, 2), PixelEstimate()};
    passes[1].pixels = {estimate(0.0f, 6), estimate(0.0f, 6)};
    const std::vector<AovChannel> channels = sums.channels(image, passes);
    const auto values = [&](const std::string& name) {
        const auto at = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
        EXPECT_NE(at, channels.end()) << name;
        return at == channels.end() ? std::vector<float>() : at->values;
    };
    EXPECT_EQ(values("A"), (std::vector<float>{0.625f, 0.0f}));
    EXPECT_EQ(values("depth.Z"), (std::vector<float>{2.0f, 0.0f})) << "mean of the samples that met something";
    EXPECT_EQ(values("shape.I"), (std::vector<float>{7.0f, 0.0f})) << "of the pixel's first sample";
    EXPECT_EQ(values("direct.G"), (std::vector<float>{2.5f, 0.0f}));
    EXPECT_EQ(values("indirect.B"), (std::vector<float>{1.5f, 0.25f}));
    EXPECT_EQ(values("spp.Y"), (std::vector<float>{8.0f, 6.0f}));
}

TEST(AovJob, WhoSeesNoLightHasNoDirectLight) {
    Job job;
    job.output.aovs = "albedo,sun:direct";
    for (const Estimator& estimator : estimators()) {
        job.integrator.type = estimator.type;
        if (estimator.sees_light && !estimator.splats()) {
            EXPECT_NO_THROW(check_job(job)) << estimator.type;
        } else {
            EXPECT_THROW(check_job(job), InputError) << estimator.type;
        }
    }
}

/// Nothing is known of what the camera sees where no ray leaves it.
TEST(AovJob, WhoComesFromTheLightsHasNoLayers) {
    for (const Estimator& estimator : estimators())
        for (const char* aovs : {"alpha", "spp"}) {
            Job job;
            job.integrator.type = estimator.type;
            job.output.aovs = aovs;
            if (estimator.has_camera_paths()) {
                EXPECT_NO_THROW(check_job(job)) << estimator.type;
                continue;
            }
            try {
                check_job(job);
                ADD_FAILURE() << estimator.type << " took " << aovs;
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("output.aovs"), std::string::npos) << error.what();
                EXPECT_NE(std::string(error.what()).find("\"path\""), std::string::npos) << error.what();
            }
        }
}

TEST(AovPlan, MemoryIsNamedWhereLayersAreOn) {
    const Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const auto coordinator = [&](const std::string& aovs) {
        Job job;
        job.output.aovs = aovs;
        return expected_memory(scene, resolve(job, scene));
    };
    const auto has_aovs = [](const MemoryPlan& plan) {
        return std::any_of(plan.coordinator.begin(), plan.coordinator.end(),
                           [](const MemoryItem& item) { return item.name == "aovs"; });
    };
    EXPECT_FALSE(has_aovs(coordinator("")));
    ASSERT_TRUE(has_aovs(coordinator("albedo,normal")));
    // Six numbers of the pass in hand, of all, and of two checkpoints, and four copies of six floats.
    const auto bytes = [&](const std::string& aovs) {  // results in transit apart
        std::uint64_t sum = 0;
        for (const MemoryItem& item : coordinator(aovs).coordinator)
            if (item.name != "results") sum += item.bytes;
        return sum;
    };
    EXPECT_EQ(bytes("albedo,normal") - bytes(""),
              scene.film.pixel_count() * (4 * 6 * sizeof(double) + 4 * 6 * sizeof(float)));
}

}  // namespace
}  // namespace treefarm
