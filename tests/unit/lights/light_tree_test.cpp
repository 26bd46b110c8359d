// SPDX-License-Identifier: Apache-2.0
// Choosing among emitters by what they bring to a point: draws against densities, bounds, corner cases.
#include "worker/lights/light_tree.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/math/frame.h"
#include "common/math/warp.h"
#include "tests/support/chi_square.h"

namespace treefarm {
namespace {

/// Numbers of a test, one after the other.
class Numbers {
  public:
    explicit Numbers(std::uint32_t stream) : stream_(stream) {}
    std::uint32_t bits() { return draw({7, stream_, 0}, next_++, Stream::light)[0]; }
    std::uint64_t bits64() { return std::uint64_t{bits()} << 32 | bits(); }
    float unit() { return to_unit(bits()); }
    Vec3 point() { return {unit(), unit(), unit()}; }
    Vec3 direction() {
        const float u = unit(), v = unit();
        return normalize(square_to_sphere({u, v}));
    }

  private:
    std::uint32_t stream_, next_ = 0;
};

/// Emitters of all sorts: patches, spheres, points, spots, suns, skies, and some that do not shine.
std::vector<LightBounds> some_lights(std::size_t count, std::uint32_t seed) {
    Numbers numbers(seed);
    std::vector<LightBounds> lights;
    for (std::size_t i = 0; i < count; ++i) {
        const double amount = std::pow(10.0, 3.0 * double(numbers.unit()) - 2.0);
        const Vec3 at = numbers.point() * 10.0f;
        Box3 box(at, at);
        const DirectionCone cone{numbers.direction(), 0.3f * numbers.unit()};
        if (count > 3 && i % 16 == 3) {
            lights.push_back(LightBounds::from_infinity(cone, 0.01 * amount));
            continue;
        }
        if (i % 5 != 1) box.extendBy(at + numbers.point());
        lights.push_back(LightBounds::in_box(box, i % 11 == 7 ? 0.0 : amount));
        if (i % 3 != 2) lights.back().cone = cone;
        if (i % 5 == 1) lights.back().falloff = 0.5f * numbers.unit();
    }
    return lights;
}

/// Half of each by its amount, half evenly; those that do not shine have none.
std::vector<double> shares_of(const std::vector<LightBounds>& lights) {
    double total = 0, shining = 0;
    for (const LightBounds& light : lights) {
        total += light.amount;
        shining += light.amount > 0;
    }
    std::vector<double> shares;
    for (const LightBounds& light : lights)
        shares.push_back(light.amount > 0 ? 0.5 * light.amount / total + 0.5 / shining : 0.0);
    return shares;
}

LightProbabilities some_probabilities() {
    LightProbabilities probabilities{};
    probabilities[0] = kLightProbabilityOne / 4;
    probabilities[1] = kLightProbabilityOne / 2;
    probabilities[2] = kLightProbabilityOne / 8;
    probabilities[4] = kLightProbabilityOne / 8;
    return probabilities;
}

/// Either choice, by the same words.
struct Choice {
    std::vector<LightBounds> lights;
    std::vector<double> shares = shares_of(lights);
    std::vector<FlatLights> flat;
    std::vector<LightTree> tree;

    Choice(std::vector<LightBounds> of, bool few) : lights(std::move(of)) {
        if (few)
            flat.emplace_back(lights, shares);
        else
            tree.emplace_back(lights, shares);
    }
    LightPick pick(std::uint64_t bits, const LightReceiver& receiver) const {
        return flat.empty() ? tree[0].pick(bits, receiver)
                            : flat[0].pick(static_cast<std::uint32_t>(bits >> 32), receiver);
    }
    float probability(std::uint32_t entry, const LightReceiver& receiver) const {
        return flat.empty() ? tree[0].probability(entry, receiver).probability : flat[0].probability(entry, receiver);
    }
};

LightReceiver some_receiver(Numbers& numbers, int i, const LightProbabilities* learned, Vec3& normal) {
    // Within the box of the lights, or far from it; every third sees all around.
    const Vec3 p = numbers.point() * (i % 4 == 0 ? 1000.0f : 10.0f);
    normal = numbers.direction();
    return {p, learned, i % 3 == 0 ? nullptr : &normal};
}

void expect_draws_as_promised(const Choice& choice, const LightProbabilities* learned, std::uint32_t seed) {
    Numbers numbers(seed);
    const std::size_t entries = choice.lights.size();
    const int points = entries > 1000 ? 4 : 16, draws = entries > 1000 ? 40000 : 10000;
    for (int i = 0; i < points; ++i) {
        Vec3 normal;
        const LightReceiver receiver = some_receiver(numbers, i, learned, normal);
        std::vector<double> counts(entries + 1, 0.0), expected(entries + 1, 0.0);
        for (int k = 0; k < draws; ++k) {
            const LightPick pick = choice.pick(numbers.bits64(), receiver);
            if (pick.entry == LightPick::kNone) {
                counts[entries] += 1;
                continue;
            }
            counts[pick.entry] += 1;
            ASSERT_GT(pick.probability, 0.0f);
            if (k < 1000) {
                ASSERT_EQ(pick.probability, choice.probability(pick.entry, receiver));
            }
        }
        double sum = 0;
        for (std::uint32_t e = 0; e < entries; ++e) {
            const double p = double(choice.probability(e, receiver));
            ASSERT_EQ(p > 0, choice.shares[e] > 0) << "no emitter that shines is never chosen";
            expected[e] = p * draws;
            sum += p;
        }
        ASSERT_LT(sum, 1.0 + 1e-5);
        expected[entries] = std::max(1.0 - sum, 0.0) * draws;
        if (counts[entries] <= 2.0) expected[entries] = counts[entries];  // what rounding left over
        EXPECT_GT(test::chi_square_test(counts, expected), 1e-4) << entries << " entries, point " << i;
    }
}

TEST(LightTree, DrawsAsOftenAsItSays) {
    const LightProbabilities learned = some_probabilities();
    for (const std::size_t count : {1u, 2u, 8u, 9u, 15u})
        for (const LightProbabilities* probabilities : {static_cast<const LightProbabilities*>(nullptr), &learned})
            expect_draws_as_promised({some_lights(count, std::uint32_t(count)), true}, probabilities, 30);
    for (const std::size_t count : {2u, 16u, 64u, 10000u})
        for (const LightProbabilities* probabilities : {static_cast<const LightProbabilities*>(nullptr), &learned})
            expect_draws_as_promised({some_lights(count, std::uint32_t(count)), false}, probabilities, 4);
}

TEST(LightTree, ManyPointsTogetherChooseWhatEachDoes) {
    const LightProbabilities learned = some_probabilities();
    for (const std::size_t count : {2u, 5u, 8u, 9u, 13u}) {
        const std::vector<LightBounds> lights = some_lights(count, 40 + std::uint32_t(count));
        const FlatLights flat(lights, shares_of(lights));
        Numbers numbers(14);
        FlatBatch batch;
        for (const std::uint32_t points : {kDrawBatch, 1u, 13u}) {
            batch.clear();
            std::vector<LightReceiver> receivers;
            std::vector<std::uint32_t> bits;
            for (std::uint32_t i = 0; i < points; ++i) {
                Vec3 normal;
                receivers.push_back(some_receiver(numbers, int(i), i % 2 ? &learned : nullptr, normal));
                bits.push_back(numbers.bits());
                batch.add(kDrawBatch - 1 - i, receivers[i], bits[i]);
            }
            flat.pick(batch);
            for (std::uint32_t i = 0; i < points; ++i) {
                const LightPick one = flat.pick(bits[i], receivers[i]), together = flat.picked(batch, i);
                ASSERT_EQ(one.entry, together.entry);
                ASSERT_EQ(one.probability, together.probability);
                ASSERT_EQ(one.cluster, together.cluster);
                LightReceiver known = receivers[i];
                LightWidthStore widths;
                batch.copy_widths(kDrawBatch - 1 - i, widths.data(), flat.count());
                known.widths = widths.data();
                for (std::uint32_t e = 0; e < lights.size(); ++e)
                    ASSERT_EQ(flat.probability(e, known), flat.probability(e, receivers[i]));
            }
        }
    }
}

/// What a light that its bounds describe well brings to a point, by one of its points and directions.
double contribution(const LightBounds& light, const LightReceiver& receiver, Numbers& numbers) {
    const Vec3 u = numbers.point();
    Vec3 axis = light.cone.axis;
    if (light.cone.half_turns > 0.0f) {
        const float cosine = sincos_turn(0.5f * light.cone.half_turns * numbers.unit()).cos;
        axis = normalize(Frame(axis).to_world(square_to_cone({0.999f, numbers.unit()}, 1.0f - cosine)));
    }
    const auto cosine_at = [&](const Vec3& wi) { return receiver.one_sided ? double(dot(receiver.front, wi)) : 1.0; };
    if (light.at_infinity) return light.amount * std::max(cosine_at(axis), 0.0);
    const Vec3 size = light.box.max - light.box.min, p = light.box.min + size * u, to = p - receiver.p;
    const double d2 = double(dot(to, to));
    if (!(d2 > 0)) return 0.0;
    const Vec3 wi = normalize(to);
    const bool all = light.cone.half_turns >= 1.0f;
    const double emitted = all ? 1.0 : double(-dot(axis, wi));
    if (!all && emitted < double(sincos_turn(0.5f * light.falloff).cos)) return 0.0;
    return light.amount * std::max(emitted, 0.0) * std::max(cosine_at(wi), 0.0) / d2;
}

TEST(LightTree, BoundsHoldWhatArrives) {
    Numbers numbers(5);
    for (int scene = 0; scene < 20; ++scene) {
        const std::vector<LightBounds> lights = some_lights(40, 100 + std::uint32_t(scene));
        const LightSpace space(lights);
        for (int i = 0; i < 500; ++i) {
            Vec3 normal;
            const LightReceiver receiver = some_receiver(numbers, i, nullptr, normal);
            LightLanes lanes;
            std::array<std::size_t, LightLanes::kCount> of;
            for (int k = 0; k < LightLanes::kCount; ++k) {
                of[std::size_t(k)] = numbers.bits() % lights.size();
                space.set(lanes, k, lights[of[std::size_t(k)]]);
            }
            LightLanes::Floats brings;
            lanes.estimate(space.normalised(receiver.p), receiver, brings);
            // An estimate takes the distance to the centre; where that is twice the radius, a point is nearer by half.
            for (std::size_t k = 0; k < LightLanes::kCount; ++k) {
                const LightBounds& light = lights[of[k]];
                const double arrives = contribution(light, receiver, numbers);
                const float total = sum_of(brings);
                if (arrives > 1e-12 * light.amount) {
                    ASSERT_GT(brings[k], 0.0f) << "light " << of[k] << " is dark, in total " << total;
                }
            }
        }
    }
}

/// Bounds of two lights hold them both: what a node lets through is dark only where both are.
TEST(LightTree, JoinedConesHoldBoth) {
    Numbers numbers(6);
    for (int i = 0; i < 20000; ++i) {
        const float spread = i % 5 == 0 ? 1e-4f : 1.0f;
        const Vec3 first = numbers.direction();
        const DirectionCone a{first, spread * numbers.unit()},
            b{i % 2 ? numbers.direction() : normalize(first + numbers.point() * spread), spread * numbers.unit()};
        const DirectionCone both = joined(a, b);
        const auto angle = [](const Vec3& u, const Vec3& v) {
            const Imath::V3d across = Imath::V3d(u).cross(Imath::V3d(v));
            return std::atan2(std::sqrt(across.dot(across)), Imath::V3d(u).dot(Imath::V3d(v))) / double(kPi);
        };
        for (const DirectionCone& cone : {a, b})
            ASSERT_LE(std::min(angle(both.axis, cone.axis) + double(cone.half_turns), 1.0),
                      double(both.half_turns) + 4e-6)
                << i;
        ASSERT_LE(both.half_turns, 1.0f);
    }
}

TEST(LightTree, AnyPowerOfTwoAsScaleDrawsTheSame) {
    const std::vector<LightBounds> lights = some_lights(40, 8);
    for (const double scale : {0x1p-20, 0x1p20}) {
        std::vector<LightBounds> scaled = lights;
        for (LightBounds& light : scaled) {
            if (light.at_infinity) continue;
            light.box.min *= static_cast<float>(scale);
            light.box.max *= static_cast<float>(scale);
            light.radius *= static_cast<float>(scale);
            light.amount *= scale * scale;
        }
        const std::vector<double> shares = shares_of(lights);
        const LightTree a(lights, shares), b(scaled, shares);
        Numbers numbers(9);
        for (int i = 0; i < 5000; ++i) {
            const Vec3 p = numbers.point() * 10.0f, n = numbers.direction();
            const std::uint64_t bits = numbers.bits64();
            const LightPick one = a.pick(bits, {p, nullptr, &n}),
                            other = b.pick(bits, {p * static_cast<float>(scale), nullptr, &n});
            ASSERT_EQ(one.entry, other.entry) << i;
            ASSERT_EQ(one.probability, other.probability) << i;
        }
    }
}

/// Lights that stand in odd ways: drawing them ends, and says how likely it was.
TEST(LightTree, OddPositionsAreDrawn) {
    const auto at = [](const Vec3& p) { return LightBounds::in_box(Box3(p, p), 1.0); };
    std::vector<std::vector<LightBounds>> scenes(5);
    for (int i = 0; i < 300; ++i) {
        const auto x = static_cast<float>(i);
        scenes[0].push_back(at({1, 2, 3}));                       // one place
        scenes[1].push_back(at({x, 2 * x, -x}));                  // a line
        scenes[2].push_back(at({x, std::sqrt(x), 0}));            // a plane
        scenes[3].push_back(at({i % 2 ? 1e30f : -1e30f, x, 0}));  // far apart
        scenes[4].push_back(at({std::ldexp(1.0f, i % 120 - 60), 0, 0}));
        if (i % 3 == 0) scenes[2].back().amount = 0;
        scenes[4].back().amount = std::ldexp(1.0, i % 200 - 100);
    }
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        const Choice choice(scenes[s], false);
        Numbers numbers(10);
        for (int i = 0; i < 2000; ++i) {
            const Vec3 normal = numbers.direction();
            Vec3 p = numbers.point() * (i % 2 ? 1.0f : 1e30f);
            if (i % 5 == 0) p = scenes[s][numbers.bits() % 300].box.min;  // in the light itself
            const LightReceiver receiver(p, nullptr, i % 3 ? &normal : nullptr);
            const LightPick pick = choice.pick(numbers.bits64(), receiver);
            if (pick.entry == LightPick::kNone) continue;
            ASSERT_GT(choice.shares[pick.entry], 0.0);
            ASSERT_TRUE(pick.probability > 0.0f && pick.probability <= 1.0f) << s << ", " << i;
            ASSERT_EQ(pick.probability, choice.probability(pick.entry, receiver)) << s << ", " << i;
        }
    }
    LightBounds nowhere = at({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    EXPECT_THROW(FlatLights(std::vector{nowhere}, std::vector{1.0}), RunError);
}

TEST(LightTree, LearnedSharesAreThoseOfItsClusters) {
    const std::vector<LightBounds> lights = some_lights(500, 11);
    const LightTree tree(lights, shares_of(lights));
    EXPECT_LE(tree.cluster_count(), kLightClusters);
    EXPECT_GE(tree.cluster_count(), kLightClusters / 2);
    LightProbabilities learned{};
    learned[0] = kLightProbabilityOne / 2;
    learned[3] = kLightProbabilityOne / 2;
    Numbers numbers(12);
    for (int i = 0; i < 20; ++i) {
        Vec3 normal;
        const LightReceiver receiver = some_receiver(numbers, i, &learned, normal);
        std::array<double, kLightClusters> sum{}, said{};
        for (std::uint32_t e = 0; e < lights.size(); ++e) {
            if (!(lights[e].amount > 0)) continue;
            const LightPick pick = tree.probability(e, receiver);
            ASSERT_EQ(pick.cluster, tree.cluster_of(e));
            sum[pick.cluster] += double(pick.probability);
            said[pick.cluster] = double(pick.cluster_probability);
        }
        for (std::size_t c = 0; c < sum.size(); ++c) {
            // Within a cluster all may be dark there.
            EXPECT_LE(sum[c], said[c] + 1e-5) << c;
        }
        EXPECT_GE(said[2], 0.4) << "learned";
    }
}

TEST(LightTree, TwentyMegabytesAreEnoughForAHundredThousand) {
    std::vector<LightBounds> lights = some_lights(100000, 13);
    const LightTree tree(lights, shares_of(lights));
    EXPECT_LT(tree.bytes(), 20'000'000u);
    EXPECT_LT(tree.node_count(), 40'000u);
}

}  // namespace
}  // namespace treefarm
