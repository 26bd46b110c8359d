// SPDX-License-Identifier: Apache-2.0
#include "tests/support/chi_square.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numeric>

#include "common/math/direction_map.h"

namespace treefarm::test {

double chi_square_p_value(double statistic, double freedom) {
    return boost::math::gamma_q(0.5 * freedom, 0.5 * std::max(statistic, 0.0));
}

double normal_p_value(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double chi_square_test(const std::vector<double>& counts, const std::vector<double>& expected) {
    std::vector<std::size_t> order(counts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    double statistic = 0, pooled_count = 0, pooled_expected = 0;
    int cells = 0;
    const auto close = [&] {
        statistic += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
        pooled_count = pooled_expected = 0;
        ++cells;
    };
    for (const std::size_t i : order) {
        if (expected[i] <= 0) {
            if (counts[i] > 0) return 0.0;
            continue;
        }
        pooled_count += counts[i];
        pooled_expected += expected[i];
        if (pooled_expected >= 5) close();
    }
    if (pooled_expected > 0.5) close();
    return cells < 2 ? 1.0 : chi_square_p_value(statistic, cells - 1);
}

DirectionTest test_directions(const std::function<bool(std::uint32_t, Vec3&)>& sample,
                              const std::function<double(const Vec3&)>& density, std::uint32_t samples, int resolution,
                              int sub) {
    const auto cells = static_cast<std::size_t>(resolution * resolution);
    std::vector<double> counts(cells, 0.0), expected(cells, 0.0);
    DirectionTest result;
    for (std::uint32_t i = 0; i < samples; ++i) {
        Vec3 d(0.0f);
        if (!sample(i, d)) continue;
        result.success += 1;
        const Vec2 p = direction_to_square(d) * static_cast<float>(resolution);
        counts[static_cast<std::size_t>(static_cast<int>(p.y) * resolution + static_cast<int>(p.x))] += 1;
    }
    const int steps = resolution * sub;
    const double solid_angle = 4 * M_PI / (double(steps) * steps);
    for (int y = 0; y < steps; ++y)
        for (int x = 0; x < steps; ++x) {
            const Vec2 p((static_cast<float>(x) + 0.5f) / static_cast<float>(steps),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(steps));
            const double mass = density(square_to_direction(p)) * solid_angle;
            expected[static_cast<std::size_t>((y / sub) * resolution + x / sub)] += mass;
            result.integral += mass;
        }
    result.success /= samples;
    for (double& e : expected)
        e *= samples;
    // Rejected samples are a cell of their own.
    counts.push_back((1 - result.success) * samples);
    expected.push_back(std::max(0.0, 1 - result.integral) * samples);
    if (counts.back() == 0) expected.back() = 0;
    result.p_value = chi_square_test(counts, expected);
    return result;
}

}  // namespace treefarm::test
