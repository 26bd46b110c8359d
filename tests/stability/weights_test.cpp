// SPDX-License-Identifier: Apache-2.0
// Weights and probabilities at the ends of their ranges.
#include "common/base/random.h"
#include "coordinator/input/check/validate.h"
#include "tests/support/hard_case.h"
#include "tests/support/material_scenes.h"
#include "worker/integrators/subpath/mis.h"
#include "worker/integrators/subpath/roulette.h"

namespace treefarm {
namespace {

using test::kInfinity;
using test::kNan;
using test::rough;

/// 1 | The power heuristic of huge or infinite densities
/// Others: squares of densities overflowed to infinity over infinity (pbrt 83d4c269, Mitsuba 3 7692954e9).
/// Here: the weight is a function of one ratio, with both ends spelled out.
/// Holds: every weight lies in [0, 1], both techniques' sum to 1 within 1e-6, w(inf, x) = 1, w(0, 0) = 0.
TEST(Weights, OfHugeAndInfiniteDensities) {
    const LetFloatsBe hostile;  // numbers that are none come in
    const float densities[] = {0.0f, 1e-45f, 1e-38f, 1e-20f, 1.0f, 1e20f, 1e30f, 3e38f, kInfinity};
    test::Worst worst;
    for (const MisHeuristic heuristic : {MisHeuristic::balance, MisHeuristic::power})
        for (const float a : densities)
            for (const float b : densities) {
                const float w = mis_weight(heuristic, a, b);
                ASSERT_TRUE(w >= 0.0f && w <= 1.0f) << a << " " << b << " " << w;
                if (a == 0.0f) {
                    ASSERT_EQ(w, 0.0f);
                } else if (std::isinf(a)) {
                    ASSERT_EQ(w, 1.0f);
                } else if (b > 0.0f && !std::isinf(b)) {
                    worst.see(std::abs(double(w) + double(mis_weight(heuristic, b, a)) - 1.0), a, b);
                }
            }
    EXPECT_LT(worst.value, 1e-6) << worst.where;
    test::figure("sum of both weights minus 1, at most", worst.value);
}

/// Every kind of BSDF that has a rough or a smooth lobe, with white parameters and the given roughness.
std::vector<decltype(Material::bsdf)> materials(float alpha) {
    const Rgb white(1.0f);
    std::vector<decltype(Material::bsdf)> all = {DiffuseMaterial{white}, PlasticMaterial{1.5f, white, white, true, {}},
                                                 DielectricMaterial{1.5f, white, white, {}}};
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann}) {
        all.push_back(ConductorMaterial{Rgb(0.2f), Rgb(3.0f), white, rough(kind, alpha, alpha)});
        all.push_back(DielectricMaterial{1.5f, white, white, rough(kind, alpha, alpha)});
        all.push_back(PlasticMaterial{1.5f, white, white, true, rough(kind, alpha, alpha)});
    }
    return all;
}

/// 2, 8 | Samples without density, and below the horizon
/// Others: sampling returned a direction with density 0 and the division made NaN (pbrt 83d42827); samples below
/// the horizon were kept (pbrt-r4 #77).
/// Here: a sample without density is "none"; a direction below the surface has neither value nor density.
/// Holds: for grazing light on rough surfaces every sample is none, or has a finite weight f cos / p of at most 2,
/// and lies above the horizon where nothing is transmitted.
TEST(Weights, SamplesWithoutDensityAreNone) {
    test::Worst worst;
    for (const float alpha : {1e-4f, 0.1f, 1.0f, 100.0f})
        for (const auto& material : materials(alpha)) {
            const test::PreparedMaterial prepared(material);
            const Bsdf& bsdf = prepared.front();
            const bool transmits = std::holds_alternative<DielectricMaterial>(material);
            for (const float cos : {1.0f, 0.1f, 1e-3f, 1e-8f})
                for (std::uint32_t i = 0; i < 4000; ++i) {
                    const Draw r = draw({3, i, 0}, 0, Stream::scatter);
                    const Vec3 wo(std::sqrt(1.0f - cos * cos), 0.0f, cos);
                    const BsdfSample s = bsdf.sample(wo, {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}});
                    if (!(s.pdf > 0.0f)) continue;
                    ASSERT_TRUE(std::isfinite(s.pdf) && is_finite(s.f_cos) && is_finite(s.wi));
                    if (!transmits) {
                        ASSERT_GT(s.wi.z, 0.0f) << alpha << " " << cos;
                    }
                    worst.see(double(max_component(s.f_cos)) / double(s.pdf), alpha, cos, s.wi);
                }
        }
    EXPECT_LT(worst.value, 2.0) << worst.where;
    test::figure("largest weight of a sample", worst.value);
}

/// A closed room that shines by itself and reflects half, with things in it that lose nothing: everything carries 2.
Scene room_of_white_things() {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    const std::int32_t mirror = test::add_material(scene, ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), {}}, true);
    const std::int32_t white = test::add_diffuse(scene, Rgb(1.0f), true);
    const std::int32_t glass = test::add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), {}});
    const std::int32_t half = test::add_material(scene, BlendMaterial{FloatInput(0.5f), mirror, white});
    const std::int32_t holes = test::add_diffuse(scene, Rgb(1.0f), true);
    scene.materials[static_cast<std::size_t>(holes)].opacity = FloatInput(0.4f);
    test::add_shape(scene, test::quad({-0.8f, -0.8f, 0.3f}, {0.8f, 0, 0}, {0, 1.5f, 0.2f}), half, Rgb(0.0f), "half");
    test::add_shape(scene, Sphere{{0.4f, 0.3f, 0.5f}, 0.3f}, glass, Rgb(0.0f), "ball");
    test::add_shape(scene, test::quad({0.1f, -0.7f, 0.2f}, {0.6f, 0, 0.1f}, {0, 0.6f, 0}), holes, Rgb(0.0f), "holes");
    scene.camera = test::look_at({0.1f, 0.1f, -0.8f}, {0.0f, 0.0f, 0.4f}, {0, 1, 0}, 0.8f);
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    return scene;
}

/// 33 | Lobes without density in a mixture with a tree
/// Others: the density of the mixture became 0 or infinite where the BSDF's was (practical-path-guiding).
/// Here: a delta lobe is sampled by the BSDF alone, at the mixture's share of its probability, and what it meets
/// counts whole: its density counts as infinite in the weights.
/// Holds: mirrors, glass, masks and blends that lose nothing are invisible in a room where everything carries 2:
/// guided or not, with next event or without, the image's mean is 2 within 4.5 standard errors and 0.5 %.
TEST(Weights, DeltaLobesBesideATree) {
    Scene scene = room_of_white_things();
    test::set_film(scene, 12, 12);
    test::Worst worst;
    for (const NextEvent next_event : {NextEvent::never, NextEvent::always})
        for (const bool guided : {false, true}) {
            Job job = guided ? test::guided_job(63, 200, next_event) : test::plain_job(63, 200, next_event);
            job.integrator.rr_depth = 40;
            const test::LocalRender run = test::render_locally(scene, job);
            EXPECT_EQ(test::invalid_samples(run), 0u);
            const test::ImageMean mean = test::mean_of(run.image);
            EXPECT_LT(std::abs(mean.value - 2.0), 4.5 * mean.error + 1e-4) << guided << " " << mean.error;
            worst.see(std::abs(mean.value / 2.0 - 1.0));
        }
    EXPECT_LT(worst.value, 0.005);
    test::figure("largest relative error of the mean", worst.value);
}

/// 37 | Roulette on black, tiny, huge and invalid throughputs
/// Others: survival probabilities of 0 or NaN were divided by (EARS clamps at 0.05, practical-path-guiding at 0.1).
/// Here: survival is at most 0.99, and where it may be 0 or NaN no path survives.
/// Holds: for every rule, throughput and brightness the survival is NaN (nobody survives) or in [0, 0.99], the weight
/// of who survives stays finite, and nobody goes on as more paths than may be.
TEST(Weights, RouletteOfAnyThroughput) {
    const LetFloatsBe hostile;  // numbers that are none come in
    float most = 0.0f;
    for (const Roulette::Rule rule :
         {Roulette::Rule::unguided, Roulette::Rule::untrained, Roulette::Rule::constant, Roulette::Rule::adjoint})
        for (const float t : {0.0f, 1e-45f, 1e-30f, 1.0f, 1e30f, 3e38f, kInfinity, kNan})
            for (const float brightness : {0x1p-60f, 1.0f, 0x1p60f})
                for (const float scale : {1e-6f, 1.0f, 1e6f}) {
                    const float survival = Roulette(rule, 1).survival(Rgb(t), scale, brightness);
                    if (std::isnan(survival)) {
                        EXPECT_FALSE(0.0f < survival) << "no random number lies below NaN";
                        continue;
                    }
                    ASSERT_TRUE(survival >= 0.0f && survival <= 0.99f) << t << " " << survival;
                    most = std::max(most, survival);
                    const std::uint32_t paths = Roulette(rule, 1).splitting(Rgb(t), scale, brightness, 32);
                    ASSERT_TRUE(paths >= 1 && paths <= 32) << t << " " << paths;
                    // The smallest random number that lets a path live is 0, and only where survival is above it.
                    if (survival > 0.0f && t < 1e30f) {
                        ASSERT_TRUE(std::isfinite(t * (1.0f / std::max(survival, 0x1p-32f))));
                    }
                }
    test::figure("largest survival", double(most));
}

/// 37 | Black surfaces
/// Others: paths went on with a throughput of 0, or divided 0 by 0 (EARS, practical-path-guiding).
/// Here: a black side is a BSDF of its own that ends the path.
/// Holds: a black room with a lamp of 1 gives 0 or 1 in each sample, no sample is invalid, nothing is recorded
/// twice.
TEST(Weights, BlackSurfacesAreBlack) {
    Scene scene;
    const std::int32_t black = test::add_diffuse(scene, Rgb(0.0f));
    test::add_shape(scene, test::box(Vec3(-1.0f), Vec3(1.0f), true), black);
    test::add_shape(scene, test::quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), black, Rgb(1.0f), "lamp");
    scene.camera = test::look_at({0, 0, -0.9f}, {0, 0.2f, 0}, {0, 1, 0}, 1.0f);
    test::set_film(scene, 16, 16);
    const test::LocalRender run = test::render_locally(scene, test::guided_job(31, 10, NextEvent::always));
    EXPECT_EQ(test::invalid_samples(run), 0u);
    double most = 0;
    for (const Rgb64& pixel : run.image.mean) {
        EXPECT_TRUE(pixel.x >= 0.0 && pixel.x <= 1.0 + 1e-9) << pixel.x;
        most = std::max(most, pixel.x);
    }
    test::figure("largest pixel", most);
}

}  // namespace
}  // namespace treefarm
