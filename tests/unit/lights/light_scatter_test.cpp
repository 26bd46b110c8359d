// SPDX-License-Identifier: Apache-2.0
// Light that comes from emitters is scattered as the walk from the camera would have it: delta lobes from both sides.
#include "worker/integrators/subpath/light_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/bsdf_samples.h"
#include "worker/integrators/subpath/technique_sums.h"

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

/// Densities along one path of k edges, from vertex 0 on the lamp to vertex k on the lens.
struct PathDensities {
    int k;
    std::vector<double> onwards, backwards;  ///< per steradian, at each vertex, to the next one and the one before
    std::vector<double> to_next, to_before;  ///< turn them into densities per area there
    std::vector<bool> delta;
    double position, next_event, film;  ///< of the lamp's point either way; of vertex k - 1 from the lens

    template <class Random>
    PathDensities(int edges, Random&& random) : k(edges), delta(static_cast<std::size_t>(edges) + 1, false) {
        const auto number = [&] { return std::exp(std::uniform_real_distribution<double>(-12, 12)(random)); };
        for (int i = 0; i <= k; ++i) {
            delta[at(i)] = i > 0 && i < k && std::uniform_int_distribution<int>(0, 3)(random) == 0;
            for (auto* values : {&onwards, &backwards})
                values->push_back(delta[at(i)] ? 1.0 : number());
            to_next.push_back(number());
            to_before.push_back(number());
        }
        position = number();
        next_event = number();
        film = number();
    }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    /// Density of vertex i per area, from the lamp's side and from the camera's.
    double from_lamp(int i) const { return i == 0 ? position : onwards[at(i - 1)] * to_next[at(i - 1)]; }
    double from_lens(int i) const { return i == k - 1 ? film : backwards[at(i + 1)] * to_before[at(i + 1)]; }
    /// Density of the whole path by the technique that draws its first s vertices from the lamp; 0: there is none.
    double of_technique(int s) const {
        if ((s > 1 && delta[at(s - 1)]) || (s > 0 && s < k && delta[at(s)])) return 0.0;
        double pdf = 1.0;
        for (int i = 0; i < k; ++i)
            pdf *= i >= s ? from_lens(i) : s == 1 ? next_event : from_lamp(i);
        return pdf;
    }
    /// The sums of a subpath at vertex i.
    TechniqueSums sums_from_lamp(int i, const Heuristic& m) const {
        if (i == 1) {
            const double pdf = position * from_lamp(1);
            return {m(next_event / pdf), m(to_before[1] / pdf)};
        }
        return sums_from_lamp(i - 1, m).after({from_lamp(i), to_before[at(i)], backwards[at(i - 1)], delta[at(i - 1)]},
                                              m);
    }
    TechniqueSums sums_from_lens(int i, const Heuristic& m) const {
        if (i == k - 1) return {m(1.0 / film), 0.0};
        return sums_from_lens(i + 1, m).after({from_lens(i), to_next[at(i)], onwards[at(i + 1)], delta[at(i + 1)]}, m);
    }
    /// What bidirectional path tracing weighs the technique by.
    double weight(int s, const Heuristic& m) const {
        double others = 0;
        if (s == 0) return technique_weight(sums_from_lens(0, m).sum(next_event, position * onwards[0], m));
        if (s == 1) {
            const double reach = position * from_lamp(1) / next_event;
            others = m(from_lens(0) / next_event) + sums_from_lens(1, m).sum(reach, reach * onwards[1], m);
            return technique_weight(others);
        }
        const double y_from_z = from_lens(s - 1), z_from_y = s < k ? from_lamp(s) : 0.0;
        others = sums_from_lamp(s - 1, m).sum(y_from_z, y_from_z * backwards[at(s - 1)], m);
        if (s < k) others += sums_from_lens(s, m).sum(z_from_y, z_from_y * onwards[at(s)], m);
        return technique_weight(others);
    }
};

/// The sums that walks carry along give what the densities of whole paths give, and the weights sum to one.
TEST(TechniqueSums, AreTheDensitiesOfWholePaths) {
    std::mt19937 random(7);
    for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power}) {
        const Heuristic m(mis);
        for (int i = 0; i < 20000; ++i) {
            const PathDensities path(2 + i % 7, random);
            double sum = 0, all = 0;
            for (int s = 0; s <= path.k; ++s)
                all += m(path.of_technique(s));
            for (int s = 0; s <= path.k; ++s) {
                const double pdf = path.of_technique(s);
                if (!(pdf > 0.0)) continue;
                const double weight = path.weight(s, m);
                ASSERT_NEAR(weight, m(pdf) / all, 1e-9) << "technique " << s << " of " << path.k << " edges";
                sum += weight;
            }
            ASSERT_NEAR(sum, 1.0, 1e-9);
        }
    }
}

/// Densities as of long glass paths: no weight is no number.
TEST(TechniqueSums, StayNumbersWhateverTheDensities) {
    const double extremes[] = {0.0, 1e-300, 1e-30, 1.0, 1e30, 1e300, std::numeric_limits<double>::infinity()};
    for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power}) {
        const Heuristic m(mis);
        for (const double pdf : extremes)
            for (const double back : extremes)
                for (const double reverse : extremes)
                    for (const bool delta : {false, true}) {
                        TechniqueSums sums{m(1e200), m(1e-200)};
                        for (int i = 0; i < 200; ++i)
                            sums = sums.after({std::max(pdf, 1e-300), back, reverse, delta}, m);
                        const double weight = technique_weight(sums.sum(pdf, pdf * reverse, m));
                        ASSERT_TRUE(weight >= 0.0 && weight <= 1.0) << pdf << " " << back << " " << reverse;
                    }
    }
}

}  // namespace
}  // namespace treefarm
