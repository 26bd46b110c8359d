// SPDX-License-Identifier: Apache-2.0
#include "common/math/warp.h"

#include <gtest/gtest.h>

#include "common/base/random.h"
#include "common/math/direction_map.h"
#include "common/math/frame.h"
#include "tests/support/chi_square.h"

namespace treefarm {
namespace {

constexpr double kWarpSignificance = 1e-4;
constexpr std::uint32_t kWarpSamples = 500000;

Vec2 uniform_pair(std::uint32_t i) {
    const Draw r = draw({11, i, 0}, 0, Stream::scatter);
    return {to_unit(r[2]), to_unit(r[3])};
}

template <class Warp, class Density>
double p_value(Warp warp, Density density) {
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        d = warp(uniform_pair(i));
        return true;
    };
    return test::test_directions(sample, density, kWarpSamples).p_value;
}

/// p-value of points of the unit square against uniformity.
template <class Map>
double square_p_value(Map map) {
    constexpr int kBins = 24;
    std::vector<double> counts(kBins * kBins, 0.0), expected(kBins * kBins, double(kWarpSamples) / (kBins * kBins));
    for (std::uint32_t i = 0; i < kWarpSamples; ++i) {
        const Vec2 p = map(uniform_pair(i)) * float(kBins);
        counts[static_cast<std::size_t>(std::min(kBins - 1, int(p.y)) * kBins + std::min(kBins - 1, int(p.x)))] += 1;
    }
    return test::chi_square_test(counts, expected);
}

TEST(WarpDistribution, UniformSphere) {
    EXPECT_GT(
        p_value([](const Vec2& u) { return square_to_sphere(u); }, [](const Vec3&) { return double(kInvFourPi); }),
        kWarpSignificance);
}

TEST(WarpDistribution, CosineHemisphere) {
    EXPECT_GT(p_value([](const Vec2& u) { return square_to_cosine_hemisphere(u); },
                      [](const Vec3& d) { return double(cosine_hemisphere_pdf(d.z)); }),
              kWarpSignificance);
}

TEST(WarpDistribution, Octahedral) {
    EXPECT_GT(
        p_value([](const Vec2& u) { return square_to_direction(u); }, [](const Vec3&) { return double(kInvFourPi); }),
        kWarpSignificance);
    EXPECT_GT(square_p_value([](const Vec2& u) { return direction_to_square(square_to_sphere(u)); }), kWarpSignificance)
        << "equal areas, tested with the other warp of the sphere";
}

TEST(WarpDistribution, Disk) {
    // Rings of equal area, in polar coordinates.
    EXPECT_GT(square_p_value([](const Vec2& u) {
                  const Vec2 d = square_to_disk(u);
                  return Vec2(d.x * d.x + d.y * d.y, std::atan2(d.y, d.x) / (2 * kPi) + 0.5f);
              }),
              kWarpSignificance);
}

TEST(WarpDistribution, Cones) {
    // The height in the cone and the angle around it are uniform, however narrow the cone.
    for (const float one_minus_cos : {1.0f, 1e-2f, 1e-6f, 1e-12f, 1e-24f}) {
        EXPECT_GT(square_p_value([&](const Vec2& u) {
                      const Vec3 d = square_to_cone(u, one_minus_cos);
                      const double sin2 = double(d.x) * d.x + double(d.y) * d.y;
                      const double h = sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
                      return Vec2(float(h / double(one_minus_cos)), std::atan2(d.y, d.x) / (2 * kPi) + 0.5f);
                  }),
                  kWarpSignificance)
            << one_minus_cos;
    }
}

TEST(WarpDistribution, Triangle) {
    // Folded to a parallelogram, the triangle's points cover a square evenly.
    std::uint32_t flip = 0;
    EXPECT_GT(square_p_value([&](const Vec2& u) {
                  const Vec2 b = square_to_triangle(u);
                  return ++flip % 2 ? b : Vec2(1.0f - b.x, 1.0f - b.y);
              }),
              kWarpSignificance);
}

TEST(Octahedral, RoundTripsEverywhere) {
    std::vector<Vec3> directions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},     {0, -1, 0},
                                    {0, 0, 1}, {0, 0, -1}, {-0.0f, 0, -1}};
    for (const float e : {1e-3f, 1e-5f, 1e-8f, 1e-20f})
        for (const float z : {1.0f, -1.0f})
            for (const Vec3& d :
                 {Vec3(e, 0, z), Vec3(0, -e, z), Vec3(-e, e, z), Vec3(1, e, z * e), Vec3(e, -1, -z * e)})
                directions.push_back(normalize(d));
    for (std::uint32_t i = 0; i < 100000; ++i)
        directions.push_back(square_to_sphere(uniform_pair(i)));
    for (const Vec3& d : directions) {
        const Vec2 p = direction_to_square(d);
        ASSERT_TRUE(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f) << d;
        const Vec3 back = square_to_direction(p);
        ASSERT_LT((back - d).length(), 2e-6f) << d;
        ASSERT_NEAR(back.length(), 1.0f, 1e-6f);
    }
}

TEST(Octahedral, CodesKeepTheirCells) {
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec2 u = uniform_pair(i);
        const std::uint32_t code = square_to_code(u);
        ASSERT_EQ(compact_bits(code), static_cast<std::uint32_t>(u.x * 65536.0f));
        ASSERT_EQ(compact_bits(code >> 1), static_cast<std::uint32_t>(u.y * 65536.0f));
    }
}

TEST(Frame, StaysOrthonormalTowardsTheSouthPole) {
    std::vector<Vec3> normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, -0x1.fffffep-1f}, {1, 0, 0}, {0, -1, 0}};
    for (const float e : {1e-2f, 1e-4f, 1e-7f, 1e-12f, 1e-30f})
        for (const float z : {-1.0f, -0x1.fffffep-1f, 1.0f})
            for (const Vec3& n : {Vec3(e, 0, z), Vec3(e, -e, z), Vec3(0, e, z)})
                normals.push_back(normalize(n));
    for (std::uint32_t i = 0; i < 10000; ++i)
        normals.push_back(square_to_sphere(uniform_pair(i)));
    for (const Vec3& n : normals) {
        const Frame f(n);
        EXPECT_NEAR(dot(cross(f.s, f.t), f.n), 1.0f, 1e-6f) << n;
        EXPECT_NEAR(dot(f.s, f.t), 0.0f, 1e-6f) << n;
        EXPECT_NEAR(dot(f.s, f.n), 0.0f, 1e-6f) << n;
        const Vec3 v = normalize(Vec3(0.3f, -0.5f, 0.7f));
        EXPECT_LT((f.to_local(f.to_world(v)) - v).length(), 1e-6f) << n;
    }
}

TEST(WarpDistribution, TheTestCanFail) {
    EXPECT_LT(p_value(
                  [](const Vec2& u) {
                      return square_to_sphere({u.x * 0.98f, u.y});
                  },
                  [](const Vec3&) { return double(kInvFourPi); }),
              kWarpSignificance);
    EXPECT_NEAR(test::chi_square_p_value(18.307, 10), 0.05, 1e-4);
    EXPECT_NEAR(test::chi_square_p_value(3.940, 10), 0.95, 1e-4);
    EXPECT_NEAR(test::normal_p_value(1.959964), 0.05, 1e-6);
}

}  // namespace
}  // namespace treefarm
