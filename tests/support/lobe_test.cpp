// SPDX-License-Identifier: Apache-2.0
#include "tests/support/lobe_test.h"

#include <cmath>
#include <vector>

#include "common/math/frame.h"
#include "tests/support/chi_square.h"

namespace treefarm::test {

LobeTest test_lobe(const std::function<bool(std::uint32_t, Vec3&)>& sample,
                   const std::function<double(const Vec3&)>& density, const Vec3& center, double across_width,
                   double along_width, std::uint32_t samples, int resolution, int sub, bool logarithmic) {
    // Frame whose axes put the horizon of a horizontal centre, where densities end, on an edge of the cells.
    Frame frame(center);
    const Vec3 across = cross(Vec3(0.0f, 0.0f, 1.0f), center);
    if (dot(across, across) > 1e-6f) {
        frame.s = normalize(across);
        frame.t = cross(center, frame.s);
    }
    const auto cells = static_cast<std::size_t>(resolution * resolution);
    std::vector<double> counts(cells, 0.0), expected(cells, 0.0);
    LobeTest result;
    // Maps coordinates to [-1, 1] along a line of cells, and back.
    constexpr double kFarthest = 30.0;
    const auto length = [&](double width) { return std::log1p(kFarthest / width); };
    const auto cell = [&](double x, double width) {
        const double u =
            logarithmic ? std::copysign(std::log1p(std::abs(x) / width) / length(width), x) : x / (std::abs(x) + width);
        return std::min(resolution - 1, static_cast<int>((u + 1) * 0.5 * resolution));
    };
    for (std::uint32_t i = 0; i < samples; ++i) {
        Vec3 d(0.0f);
        if (!sample(i, d)) continue;
        const Vec3 local = frame.to_local(d);
        if (!(local.z > 0.0f)) continue;
        const double across = double(local.x) / double(local.z), along = double(local.y) / double(local.z);
        if (logarithmic && !(std::abs(across) < kFarthest && std::abs(along) < kFarthest)) continue;
        result.inside += 1;
        const int x = cell(across, across_width), y = cell(along, along_width);
        counts[static_cast<std::size_t>(y * resolution + x)] += 1;
    }
    const int steps = resolution * sub;
    const auto coordinate = [&](int i, double width, double& jacobian) {
        const double u = 2 * (i + 0.5) / steps - 1, rest = 1 - std::abs(u);
        if (logarithmic) {
            const double x = width * std::expm1(std::abs(u) * length(width));
            jacobian = (x + width) * length(width) * 2 / steps;
            return std::copysign(x, u);
        }
        jacobian = width / (rest * rest) * 2 / steps;
        return u * width / rest;
    };
    for (int iy = 0; iy < steps; ++iy)
        for (int ix = 0; ix < steps; ++ix) {
            double jx, jy;
            const double x = coordinate(ix, across_width, jx), y = coordinate(iy, along_width, jy),
                         length2 = 1 + x * x + y * y;
            const double scale = 1 / std::sqrt(length2);
            const Vec3 local(static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(scale));
            const double mass = density(normalize(frame.to_world(local))) * jx * jy * scale / length2;
            expected[static_cast<std::size_t>((iy / sub) * resolution + ix / sub)] += mass;
            result.integral += mass;
        }
    for (double& e : expected)
        e *= samples;
    // The integral is accurate to about 1e-3; a finer test of the remainder would test that.
    const double outside = samples - result.inside, left = (1 - result.integral) * samples;
    counts.push_back(outside);
    expected.push_back(std::abs(outside - left) < 1e-3 * samples ? outside : std::max(0.0, left));
    result.inside /= samples;
    result.p_value = chi_square_test(counts, expected);
    return result;
}

}  // namespace treefarm::test
