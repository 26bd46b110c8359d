// SPDX-License-Identifier: Apache-2.0
// Light that comes from emitters is scattered as the walk from the camera would have it: delta lobes from both sides.
#include "worker/integrators/subpath/light_scatter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/bsdf_samples.h"

namespace treefarm {
namespace {

/// What all ways of a BSDF from wo to wi, delta lobes, carry: the sum of f_cos, each with its role if `as_light`.
double carried(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, bool as_light) {
    double sum = 0;
    constexpr int kLobes = 512;
    Vec3 last(0.0f);
    float last_pdf = -1;
    for (int i = 0; i < kLobes; ++i) {
        const BsdfRandom random{(static_cast<float>(i) + 0.5f) / kLobes, Vec2(0.4f, 0.7f)};
        const BsdfSample s = bsdf.sample(wo, random);
        if (!(s.pdf > 0.0f) || !s.delta || (s.wi - wi).length() > 2e-4f) continue;
        // Each lobe counts once: they come one after the other.
        if (s.wi == last && s.pdf == last_pdf) continue;
        last = s.wi;
        last_pdf = s.pdf;
        sum += double(s.f_cos.y) * (as_light ? double(delta_role(bsdf, wo, s.wi, random)) : 1.0);
    }
    return sum;
}

struct Sides {
    std::string name;
    Bsdf front, back;  ///< of the same place, z turned
    double eta = 1;    ///< of the back's side over the front's
};

Vec3 turned(const Vec3& w, bool turn) {
    return turn ? Vec3(w.x, w.y, -w.z) : w;
}

/// F(in -> out) per density is the camera's f_cos(out -> in) times |dw_out / dw_in|: what conserves power.
void expect_roles(const Sides& sides, float normal_tilt = 0.0f) {
    int compared = 0;
    for (const float cosine : {0.95f, 0.6f, 0.35f})
        for (const float azimuth : {0.3f, 2.0f, 4.5f}) {
            const Vec3 in = test::at_cosine(cosine, azimuth);
            for (int i = 0; i < 16; ++i) {
                const BsdfRandom random{(static_cast<float>(i) + 0.5f) / 16, Vec2(0.4f, 0.7f)};
                const BsdfSample s = sides.front.sample(in, random);
                if (!(s.pdf > 0.0f) || !s.delta) continue;
                const bool through = s.wi.z < 0.0f;
                const double as_light = carried(sides.front, in, s.wi, true);
                const Vec3 from = turned(s.wi, through);
                const double camera = carried(through ? sides.back : sides.front, from, turned(in, through), false);
                // |in . n| / |out . n| of the lobe's own normal, and what refraction has taken from the camera's.
                const Vec3 n = normalize(Vec3(normal_tilt, 0, 1));
                const double ratio = std::abs(double(dot(in, n)) / double(dot(s.wi, n)));
                const bool straight = (s.wi + in).length() < 1e-5f;
                const double eta = through && !straight ? 1 / sides.eta : 1.0;
                EXPECT_NEAR(as_light, camera * ratio * eta * eta, 2e-3 * as_light) << sides.name << " lobe " << i;
                ++compared;
            }
        }
    EXPECT_GT(compared, 20) << sides.name;
}

TEST(LightScatter, DeltaLobesFromBothSides) {
    expect_roles({"metal", {ConductorBsdf{Rgb(0.2f), Rgb(3.9f), Rgb(0.9f)}}, {BlackBsdf{}}});
    const Rgb colour(0.8f, 0.7f, 0.9f);
    for (const float eta : {1.5f, 1.0f / 1.33f})
        expect_roles({"glass",
                      {DielectricBsdf{eta, Rgb(1.0f), colour}},
                      {DielectricBsdf{1 / eta, Rgb(1.0f), colour}},
                      double(eta)});
    expect_roles(
        {"pane", {ThinDielectricBsdf{1.5f, Rgb(1.0f), colour}}, {ThinDielectricBsdf{1.5f, Rgb(1.0f), colour}}});
    expect_roles({"nothing", {NullBsdf{colour}}, {NullBsdf{colour}}});
    const Bsdf glass{DielectricBsdf{1.5f, Rgb(1.0f), colour}}, from_inside{DielectricBsdf{1 / 1.5f, Rgb(1.0f), colour}},
        nothing{NullBsdf{Rgb(1.0f)}};
    expect_roles(
        {"glass, in part", {BlendBsdf{0.3f, &glass, &nothing}}, {BlendBsdf{0.3f, &from_inside, &nothing}}, 1.5});
    expect_roles(
        {"nothing, in part", {BlendBsdf{0.6f, &nothing, &glass}}, {BlendBsdf{0.6f, &nothing, &from_inside}}, 1.5});
}

TEST(LightScatter, TiltedMirrors) {
    const Bsdf metal{ConductorBsdf{Rgb(0.2f), Rgb(3.9f), Rgb(0.9f)}};
    OrientedBsdf tilted;
    tilted.inner = &metal;
    tilted.n = normalize(Vec3(0.2f, 0, 1));
    tilted.t = Vec3(0, 1, 0);
    tilted.s = cross(tilted.t, tilted.n);
    expect_roles({"tilted", {tilted}, {BlackBsdf{}}}, 0.2f);
    tilted.shadow_alpha2 = 0.4f;
    expect_roles({"tilted, with its shadows", {tilted}, {BlackBsdf{}}}, 0.2f);
}

}  // namespace
}  // namespace treefarm
