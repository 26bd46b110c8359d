// SPDX-License-Identifier: Apache-2.0
// Why direct light is sampled from both ends: plates and lamps after Veach 1997, each lamp alone on each plate.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "common/math/vec.h"
#include "coordinator/input/load.h"
#include "tests/support/aov_render.h"

namespace treefarm {
namespace {

constexpr std::size_t kPlates = 4, kLamps = 4;
constexpr std::uint32_t kSpp = 128;

using Row = std::array<double, kPlates>;  ///< a lamp's, by plate

Scene plates_under(std::size_t lamp) {
    Scene scene = load_scene(TREEFARM_SOURCE_DIR "/configs/scenes/plates.xml", {}, false, 96, 64).scene;
    for (std::size_t l = 0; l < scene.emitters.size(); ++l)
        if (l != lamp) std::get<AreaEmitter>(scene.emitters[l].kind).radiance.value = Rgb(0.0f);
    return scene;
}

/// Means over the pixels of each plate, under one lamp.
struct Cells {
    Row variance{};  ///< of a sample, which is its squared error: samples are unbiased
    Row square{};    ///< of the light
};

Cells direct_light(const Scene& scene, int emitter_samples, int bsdf_samples, MisHeuristic mis) {
    Job job;
    job.integrator.type = "direct";
    job.integrator.next_event = NextEvent::always;
    job.integrator.emitter_samples = emitter_samples;
    job.integrator.bsdf_samples = bsdf_samples;
    job.integrator.mis = mis;
    const test::Layers image = test::render_layers(scene, "material", kSpp, job);
    Cells cells;
    Row counts{};
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        const float material = image["material.I"][p] - 2;  // 1 is the wall; a fraction: an edge
        if (material < 0 || material != std::floor(material)) continue;
        const auto plate = static_cast<std::size_t>(material);
        const Moments samples = image.pixels[p].whole();
        cells.variance.at(plate) += luminance(samples.sample_variance());
        const double light = luminance(samples.mean);
        cells.square.at(plate) += light * light;
        counts.at(plate) += 1;
    }
    for (std::size_t plate = 0; plate < kPlates; ++plate) {
        cells.variance[plate] /= counts[plate];
        cells.square[plate] /= counts[plate];
    }
    return cells;
}

/// Cavus 2020, figure 2.12: one sample of the emitter, one of the BSDF, or both. The balance heuristic adds at most
/// half of the squared light to the variance of the better one (Veach 1997, theorem 9.2), the power heuristic 0.4 of
/// that variance, as measured; either one alone is ten times as bad somewhere.
TEST(Plates, BothSamplesTogetherAreGoodInEveryCell) {
    double worst_emitter = 0, worst_bsdf = 0;
    for (std::size_t lamp = 0; lamp < kLamps; ++lamp) {
        const Scene scene = plates_under(lamp);
        const Cells both = direct_light(scene, 1, 1, MisHeuristic::balance);
        const Cells power = direct_light(scene, 1, 1, MisHeuristic::power);
        const Cells emitter = direct_light(scene, 1, 0, MisHeuristic::balance);
        const Cells bsdf = direct_light(scene, 0, 1, MisHeuristic::balance);
        for (std::size_t plate = 0; plate < kPlates; ++plate) {
            SCOPED_TRACE("lamp " + std::to_string(lamp + 1) + ", plate " + std::to_string(plate + 1));
            const double better = std::min(emitter.variance[plate], bsdf.variance[plate]);
            EXPECT_LE(both.variance[plate], 1.1 * better + 0.5 * both.square[plate]);
            EXPECT_LE(power.variance[plate], 1.5 * better);
            worst_emitter = std::max(worst_emitter, emitter.variance[plate] / both.variance[plate]);
            worst_bsdf = std::max(worst_bsdf, bsdf.variance[plate] / both.variance[plate]);
        }
    }
    EXPECT_GT(worst_emitter, 10.0);
    EXPECT_GT(worst_bsdf, 10.0);
}

}  // namespace
}  // namespace treefarm
