// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/colour/hosek_wilkie.h"

#include <cmath>

#include "coordinator/input/colour/hosek_wilkie_data.h"

namespace treefarm {
namespace {

using Rgb64 = Imath::Color3<double>;

constexpr std::size_t kControlPoints = 6, kTurbidities = 10, kColumns = 10, kElevations = 30;

/// Position of a number among the nodes 0, 1... `count` - 1: the node before it, and the fraction of the way to the
/// next, from 0 to 1.
struct GridPosition {
    std::size_t node;
    double fraction;
};

GridPosition position_among(std::size_t count, double at) {
    const double inside = std::clamp(at, 0.0, static_cast<double>(count - 1));
    const std::size_t node = std::min(static_cast<std::size_t>(inside), count - 2);
    return {node, inside - static_cast<double>(node)};
}

/// Bernstein polynomials of degree 5: weights of the control points of a Bezier curve at t, from 0 to 1.
std::array<double, kControlPoints> bezier_weights(double t) {
    constexpr double kBinomial[kControlPoints] = {1.0, 5.0, 10.0, 10.0, 5.0, 1.0};
    std::array<double, kControlPoints> weights;
    double power = 1.0;
    for (std::size_t i = 0; i < kControlPoints; ++i, power *= t)
        weights[i] = kBinomial[i] * power;
    power = 1.0;
    for (std::size_t i = kControlPoints; i-- > 0; power *= 1.0 - t)
        weights[i] *= power;
    return weights;
}

/// A channel's columns: linear in turbidity and albedo, a Bezier curve over the cube root of the elevation.
std::array<double, kColumns> interpolate(const HosekWilkieTable& table, double turbidity, double albedo,
                                         double sun_elevation) {
    const GridPosition at_turbidity = position_among(kTurbidities, turbidity - 1.0);
    const auto curve = bezier_weights(std::cbrt(std::clamp(sun_elevation / (M_PI / 2.0), 0.0, 1.0)));
    std::array<double, kColumns> columns{};
    for (const std::size_t ground : {0u, 1u})
        for (const std::size_t step : {0u, 1u}) {
            const double weight =
                (ground ? albedo : 1.0 - albedo) * (step ? at_turbidity.fraction : 1.0 - at_turbidity.fraction);
            const std::size_t first = (ground * kTurbidities + at_turbidity.node + step) * kControlPoints;
            for (std::size_t point = 0; point < kControlPoints; ++point)
                for (std::size_t column = 0; column < kColumns; ++column)
                    columns[column] += weight * curve[point] * table[first + point][column];
        }
    return columns;
}

}  // namespace

HosekWilkieSky::HosekWilkieSky(double turbidity, const Rgb64& albedo, double sun_elevation)
    : channels_{interpolate(kHosekWilkieRed, turbidity, albedo.x, sun_elevation),
                interpolate(kHosekWilkieGreen, turbidity, albedo.y, sun_elevation),
                interpolate(kHosekWilkieBlue, turbidity, albedo.z, sun_elevation)} {}

Rgb64 HosekWilkieSky::radiance(double zenith, double from_sun) const {
    const double cosine = std::max(std::cos(zenith), 0.0);
    const double cos_from_sun = std::cos(from_sun), square = cos_from_sun * cos_from_sun;
    Rgb64 rgb;
    for (int c = 0; c < 3; ++c) {
        const auto& [A, B, C, D, E, F, G, I, H, mean] = channels_[static_cast<std::size_t>(c)];
        const double gradient = 1.0 + A * std::exp(B / (cosine + 0.01));
        const double halo = (1.0 + square) / std::pow(1.0 + H * H - 2.0 * H * cos_from_sun, 1.5);
        const double around_sun = C + D * std::exp(E * from_sun) + F * square + G * halo + I * std::sqrt(cosine);
        rgb[c] = std::max(gradient * around_sun * mean, 0.0);
    }
    return rgb;
}

Rgb64 hosek_wilkie_sun(double turbidity, double sun_elevation) {
    const GridPosition row = position_among(kTurbidities, turbidity - 1.0);
    const GridPosition column = position_among(kElevations, (sun_elevation * 180.0 / M_PI - 2.0) / 3.0);
    Rgb64 rgb;
    for (int c = 0; c < 3; ++c) {
        const auto along = [&](std::size_t r) {
            const auto& of = kHosekWilkieSun[r];
            return of[column.node][c] * (1.0 - column.fraction) + of[column.node + 1][c] * column.fraction;
        };
        rgb[c] = std::max(along(row.node) * (1.0 - row.fraction) + along(row.node + 1) * row.fraction, 0.0);
    }
    return rgb;
}

}  // namespace treefarm
