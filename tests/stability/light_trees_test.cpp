// SPDX-License-Identifier: Apache-2.0
// Choosing among lamps from far away, from within them, and by bounds that hardly are any.
#include <numeric>
#include <tuple>

#include "common/math/warp.h"
#include "common/plan/resolve/resolve.h"
#include "tests/support/hard_case.h"
#include "tests/support/test_scenes.h"
#include "worker/lights/light_tree.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {
namespace {

/// Numbers of a test, one after the other.
class Numbers {
  public:
    std::uint64_t bits64() {
        const Draw random = draw({21, 0, 0}, next_++, Stream::light);
        return std::uint64_t{random[0]} << 32 | random[1];
    }
    float unit() { return to_unit(static_cast<std::uint32_t>(bits64() >> 32)); }
    Vec3 point() { return {unit() - 0.5f, unit() - 0.5f, unit() - 0.5f}; }
    Vec3 direction() {
        const float u = unit(), v = unit();
        return normalize(square_to_sphere({u, v}));
    }

  private:
    std::uint32_t next_ = 0;
};

/// Lamps within about 1 of the origin, of powers 1e-30 to 1e30, or all alike; `odd`: points, flat boxes, suns, skies,
/// and cones of any width about any axis, or none.
std::vector<LightBounds> some_lights(std::size_t count, bool odd, bool alike, Numbers& numbers) {
    std::vector<LightBounds> lights;
    for (std::size_t i = 0; i < count; ++i) {
        const double amount = alike ? 1.0 : std::pow(10.0, 60.0 * double(numbers.unit()) - 30.0);
        const Vec3 at = i % 7 == 6 ? Vec3(0.25f) : numbers.point();  // some stand in one place
        Box3 box(at, at);
        if (i % 3 == 1) box.extendBy(at + Vec3(0.1f, i % 2 ? 0.0f : 0.1f, i % 5 ? 0.1f : 0.0f));
        lights.push_back(LightBounds::in_box(box, amount));
        if (!odd) continue;
        const DirectionCone cones[] = {DirectionCone::all(),        {numbers.direction(), 0.0f}, {Vec3(0.0f), 0.0f},
                                       {numbers.direction(), 1.0f}, {Vec3(0.0f), 1.0f},          {Vec3(0, 0, -1), 0.5f},
                                       {numbers.direction(), 1e-7f}};
        lights.back().cone = cones[i % std::size(cones)];
        if (i % 4 == 2) lights.back().falloff = 1e-6f;
        if (i % 16 == 5) lights.back() = LightBounds::from_infinity(cones[i / 16 % std::size(cones)], amount);
    }
    return lights;
}

/// Half of each by its amount, half evenly.
std::vector<double> shares_of(const std::vector<LightBounds>& lights) {
    const double total = std::accumulate(lights.begin(), lights.end(), 0.0,
                                         [](double sum, const LightBounds& light) { return sum + light.amount; });
    std::vector<double> shares;
    for (const LightBounds& light : lights)
        shares.push_back(0.5 * light.amount / total + 0.5 / static_cast<double>(lights.size()));
    return shares;
}

/// Points on lamps and in their boxes, and 1e-6 to 1e6 sizes away from one of them.
std::vector<Vec3> some_points(const std::vector<LightBounds>& lights, Numbers& numbers) {
    std::vector<Vec3> points = {Vec3(0.25f), Vec3(0.0f)};
    for (const float away : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
        for (int i = 0; i < 6; ++i) {
            const LightBounds& light = lights[numbers.bits64() % lights.size()];
            if (light.at_infinity) continue;
            points.push_back(light.box.min + numbers.direction() * away);
            points.push_back(light.box.max);
        }
    return points;
}

LightPick pick_of(const LightTree& tree, std::uint64_t bits, const LightReceiver& receiver) {
    return tree.pick(bits, receiver);
}
LightPick pick_of(const FlatLights& few, std::uint64_t bits, const LightReceiver& receiver) {
    return few.pick(static_cast<std::uint32_t>(bits >> 32), receiver);
}
float probability_of(const LightTree& tree, std::uint32_t entry, const LightReceiver& receiver) {
    return tree.probability(entry, receiver).probability;
}
float probability_of(const FlatLights& few, std::uint32_t entry, const LightReceiver& receiver) {
    return few.probability(entry, receiver);
}

/// Holds what a choice among so many says of itself against what it does; returns the sum of the probabilities.
template <class Choice>
double checked_sum(const Choice& choice, std::uint32_t count, const LightReceiver& receiver, Numbers& numbers) {
    double sum = 0;
    for (std::uint32_t e = 0; e < count; ++e) {
        const float probability = probability_of(choice, e, receiver);
        EXPECT_TRUE(probability > 0.0f && probability <= 1.0f) << probability << " " << e << " of " << count;
        sum += double(probability);
    }
    EXPECT_LT(sum, 1.0 + 1e-5) << count << " " << receiver.p;
    constexpr int kPicks = 300;
    int nothing = 0;
    for (int i = 0; i < kPicks; ++i) {
        const LightPick pick = pick_of(choice, numbers.bits64(), receiver);
        nothing += pick.entry == LightPick::kNone;
        if (pick.entry == LightPick::kNone) continue;
        EXPECT_EQ(pick.probability, probability_of(choice, pick.entry, receiver)) << pick.entry << receiver.p;
    }
    const double left = kPicks * std::max(1.0 - sum, 0.0);
    EXPECT_NEAR(nothing, left, 5 * std::sqrt(left) + 1) << count << " " << receiver.p;
    return sum;
}

/// 21 | Choosing among lamps from 1e-6 to 1e6 of their sizes away
/// Others: angles of cones lost their digits far away, and importances were NaN (Cycles 03cc1001e, 97ded32a7).
/// Here: sines and cosines instead of angles; probabilities are whole numbers, and an eighth is drawn without them.
/// Holds: for 2 to 300 lamps of powers 1e-30 to 1e30, points, flat boxes, suns, skies, with cones of every width or
/// without an axis, from on, in, near and far: every probability is finite and above 0, they sum to at most 1 (of
/// lamps that shine all around: to 1 within 1e-4), a pick says the same bits, and nothing is picked as often as is
/// left.
TEST(LightTrees, FromAnyDistance) {
    Numbers numbers;
    LightProbabilities learned{};
    learned[0] = learned[2] = kLightProbabilityOne / 2;
    test::Worst worst;
    for (const auto& [count, odd, alike] : {std::tuple(2u, true, false),
                                            {15u, true, false},
                                            {15u, false, true},
                                            {40u, true, true},
                                            {300u, true, false},
                                            {300u, false, false}}) {
        const std::vector<LightBounds> lights = some_lights(count, odd, alike, numbers);
        const LightTree tree(lights, shares_of(lights));
        const std::vector<LightBounds> few(lights.begin(), lights.begin() + std::min(count, 15u));
        const FlatLights flat(few, shares_of(few));
        for (const Vec3& p : some_points(lights, numbers))
            for (int kind = 0; kind < 4; ++kind) {
                const Vec3 normal = kind == 1 && p != Vec3(0.0f) ? normalize(p) : numbers.direction();
                const LightReceiver receiver(p, kind == 3 ? &learned : nullptr, kind == 0 ? nullptr : &normal);
                const double sums[] = {checked_sum(tree, count, receiver, numbers),
                                       checked_sum(flat, static_cast<std::uint32_t>(few.size()), receiver, numbers)};
                if (odd || kind > 0) continue;
                for (const double sum : sums)
                    worst.see(std::abs(sum - 1.0), count, p);
            }
    }
    EXPECT_LT(worst.value, 1e-4) << worst.where;
    test::figure("sum of the probabilities minus 1, of lamps that shine all around, at most", worst.value);
}

/// 21 | Lamps by their light, from 1e-6 to 1e6 sizes away
/// Others: far away all emitters were as likely, or one that was dark (Cycles 59564b1d1).
/// Here: the tree's own units, in which the scene's size is about 1; cosines of vectors from differences in float.
/// Holds: the probabilities of five small flat lamps are those of their irradiances in double (amount, both cosines,
/// squared distance) and of an eighth by shares, within 2e-3.
TEST(LightTrees, ByTheirLightFromAnyDistance) {
    Numbers numbers;
    test::Worst worst;
    int compared = 0;
    for (const float away : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
        for (int i = 0; i < 1000; ++i) {
            std::vector<LightBounds> lights;
            // Lamps at two corners keep the tree's origin at 0: so near to the others differences stay exact.
            for (const Vec3& at :
                 {Vec3(0.0f), Vec3(0.25f, -0.125f, 0.5f), Vec3(0.5f, 0.25f, -0.25f), Vec3(1.0f), Vec3(-1.0f)}) {
                lights.push_back(LightBounds::in_box(Box3(at, at), std::pow(10.0, 2.0 * double(numbers.unit()))));
                lights.back().cone = {numbers.direction(), 0.0f};
            }
            const std::vector<double> shares = shares_of(lights);
            const Vec3 p = numbers.direction() * away, normal = numbers.direction();
            std::vector<double> brings;
            double total = 0, faced = 0;
            for (const LightBounds& light : lights) {
                const Imath::V3d to = Imath::V3d(light.box.min) - Imath::V3d(p);
                const double d2 = to.dot(to), received = Imath::V3d(normal).dot(to) / std::sqrt(d2),
                             emitted = -Imath::V3d(light.cone.axis).dot(to) / std::sqrt(d2);
                brings.push_back(light.amount * std::max(received, 0.0) * std::max(emitted, 0.0) / d2);
                total += brings.back();
                faced += light.amount / d2;
            }
            if (!(total > 0.1 * faced)) continue;  // cones are taken to be 1e-4 wider: at grazing angles it shows
            ++compared;
            const FlatLights flat(lights, shares);
            for (std::uint32_t e = 0; e < lights.size(); ++e)
                worst.see(std::abs(double(flat.probability(e, LightReceiver(p, nullptr, &normal))) -
                                   (0.875 * brings[e] / total + 0.125 * shares[e])),
                          away, i, e);
        }
    EXPECT_LT(worst.value, 2e-3) << worst.where;
    EXPECT_GT(compared, 500);
    test::figure("largest error of a probability", worst.value);
}

/// 21 | Cones without an axis, opposite ones, and full ones
/// Others: the axis of two joined cones became NaN (Cycles 59564b1d1).
/// Here: angles by sine and cosine; cones so nearly opposite that no plane turns one into the other are joined to the
/// whole sphere.
/// Holds: for axes that are equal, opposite (200 of any direction among them), one step of float off, tiny or zero,
/// with widths 0 to pi, joined cones have a finite axis and hold both within 4e-6 half turns; costs of their bounds
/// are finite.
TEST(LightTrees, ConesOfEveryKind) {
    Numbers numbers;
    const float step = std::nextafter(1.0f, 0.0f);
    std::vector<std::pair<Vec3, Vec3>> pairs;
    const Vec3 axes[] = {Vec3(0, 0, 1),          Vec3(0, 0, -1),       Vec3(0, 0, step), Vec3(1e-7f, 0, -1),
                         Vec3(1e-20f, 0, -1),    Vec3(1e-40f, 0, 1),   Vec3(0.0f),       Vec3(1e-40f, 0, 0),
                         Vec3(0.6f, 0.0f, 0.8f), Vec3(-0.6f, 0, -0.8f)};
    for (const Vec3& first : axes)
        for (const Vec3& second : axes)
            pairs.emplace_back(first, second);
    for (int i = 0; i < 200; ++i) {
        const Vec3 axis = numbers.direction();
        pairs.emplace_back(axis, i % 2 ? -axis : normalize(numbers.point() * 1e-6f - axis));
    }
    test::Worst worst;
    const auto half_turns = [](const Vec3& u, const Vec3& v) {
        return std::atan2(Imath::V3d(u).cross(Imath::V3d(v)).length(), Imath::V3d(u).dot(Imath::V3d(v))) / M_PI;
    };
    for (const auto& [first, second] : pairs)
        for (const float a : {0.0f, 1e-7f, 0.3f, 0.5f, 1.0f})
            for (const float b : {0.0f, 1e-7f, 0.5f, step, 1.0f}) {
                const DirectionCone both = joined(DirectionCone{first, a}, DirectionCone{second, b});
                ASSERT_TRUE(is_finite(both.axis)) << first << second << a << " " << b;
                ASSERT_TRUE(both.half_turns >= std::max(a, b) && both.half_turns <= 1.0f) << both.half_turns;
                LightBounds bounds = LightBounds::in_box(Box3(first, first), 1.0);
                bounds.cone = both;
                ASSERT_TRUE(std::isfinite(sampling_cost(bounds, 1e-3)));
                if (first.length() < 0.5f || second.length() < 0.5f) continue;
                for (const auto& [axis, width] : {std::pair(first, a), {second, b}})
                    worst.see(std::min(half_turns(axis, both.axis) + double(width), 1.0) - double(both.half_turns),
                              first, second, a, b);
            }
    EXPECT_LT(worst.value, 4e-6) << worst.where;
    test::figure("half turns by which a joined cone is too narrow, at most", worst.value);
}

/// 21 | A hall of lamps from afar
/// Others: light of far clusters was lost, or fireflies (Cycles 97ded32a7).
/// Here: see above; the tree's estimates are of the distance to what is seen, whatever its scale.
/// Holds: the irradiance of 36 lamps, of radiances 1e-3 to 1e3, by next event through the tree is that of their areas,
/// cosines and distances within 4.5 standard errors and 1e-3, from 0.1 to 1e6 of their distances away.
TEST(LightTrees, IrradianceOfAHallFromAfar) {
    Scene scene;
    for (int i = 0; i < 36; ++i)
        test::add_shape(scene,
                        test::quad({static_cast<float>(i % 6) - 2.5f, static_cast<float>(i / 6) - 2.5f, 0},
                                   {0, 0.01f, 0}, {0.01f, 0, 0}),
                        kNone, Rgb(std::pow(10.0f, static_cast<float>(i % 7) - 3.0f)));
    Job job;
    job.integrator.light_selection = LightSelection::tree;
    const TraceScene lit(scene, resolve(job, scene));
    test::Worst worst;
    for (const float away : {0.1f, 1.0f, 1e3f, 1e6f}) {
        const Vec3 p(0.3f * away, 0.1f, -away), up(0, 0, 1);
        double exact = 0, sum = 0, squares = 0;
        for (int i = 0; i < 36; ++i) {
            const Imath::V3d to(i % 6 - 2.495 - double(p.x), i / 6 - 2.495 - double(p.y), double(away));
            exact += std::pow(10.0, i % 7 - 3.0) * 1e-4 * to.z * to.z / (to.dot(to) * to.dot(to));
        }
        constexpr std::uint32_t kSamples = 20000;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const DirectSample s =
                lit.emitters().sample_direct(LightReceiver(p, nullptr, &up), draw({22, i, 0}, 1, Stream::light));
            const double value = s.pdf > 0.0f ? double(s.radiance.x) * double(s.wi.z) / double(s.pdf) : 0.0;
            sum += value / kSamples;
            squares += value * value / kSamples;
        }
        const double error = std::sqrt((squares - sum * sum) / kSamples);
        EXPECT_NEAR(sum / exact, 1.0, 4.5 * error / exact + 1e-3) << away;
        EXPECT_LT(error, 0.01 * exact) << away << ": too noisy to tell";
        worst.see(std::abs(sum / exact - 1.0), away);
    }
    test::figure("largest relative error of the irradiance", worst.value);
}

}  // namespace
}  // namespace treefarm
