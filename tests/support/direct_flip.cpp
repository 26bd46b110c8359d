// SPDX-License-Identifier: Apache-2.0
#include "tests/support/direct_flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace treefarm {

namespace {

constexpr double kPi64 = std::numbers::pi;
using V = std::array<double, 3>;

V xyz(const V& c) {
    return {0.433895388832 * c[0] + 0.376242372622 * c[1] + 0.189862238546 * c[2],
            0.212636821677 * c[0] + 0.715182981841 * c[1] + 0.072180196481 * c[2],
            0.017752423152 * c[0] + 0.109465628662 * c[1] + 0.872781948186 * c[2]};
}

V opponent(const Rgb& c) {
    const V v = xyz({c.x, c.y, c.z});
    return {116 * v[1] - 16, 500 * (v[0] - v[1]), 200 * (v[1] - v[2])};
}

V lab(const V& c) {
    V v = xyz(c);
    for (double& t : v)
        t = t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
    const double l = 116 * v[1] - 16;
    return {l, 0.01 * l * 500 * (v[0] - v[1]), 0.01 * l * 200 * (v[1] - v[2])};
}

double distance(const V& p, const V& q) {
    return std::pow(std::abs(p[0] - q[0]) + std::hypot(p[1] - q[1], p[2] - q[2]), 0.7);
}

/// Convolution of the opponent colours with weight(dx, dy, channel), normalised over a window.
template <class Weight>
V filtered(const RgbImage& image, int x, int y, int radius, const Weight& weight) {
    V sum{}, weights{};
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const int u = std::clamp(x + dx, 0, image.width - 1), v = std::clamp(y + dy, 0, image.height - 1);
            const V value = opponent(image.pixels[static_cast<std::size_t>(v * image.width + u)]);
            for (std::size_t c = 0; c < 3; ++c) {
                sum[c] += weight(dx, dy, c) * value[c];
                weights[c] += weight(dx, dy, c);
            }
        }
    return {sum[0] / weights[0], sum[1] / weights[1], sum[2] / weights[2]};
}

V perceived_colour(const RgbImage& image, int x, int y, double ppd) {
    const auto weight = [&](int dx, int dy, std::size_t c) {
        const double d2 = (dx * dx + dy * dy) / (ppd * ppd);
        const auto term = [&](double a, double b) {
            return a * std::sqrt(kPi64 / b) * std::exp(-kPi64 * kPi64 * d2 / b);
        };
        return c == 0 ? term(1, 0.0047) : c == 1 ? term(1, 0.0053) : term(34.1, 0.04) + term(13.5, 0.025);
    };
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi64 * kPi64)) * ppd));
    const V o = filtered(image, x, y, radius, weight);
    const double luminance = (o[0] + 16) / 116;
    const V v{luminance + o[1] / 500, luminance, luminance - o[2] / 200};
    V rgb{3.080341988280 * v[0] - 1.537398969489 * v[1] - 0.542943018792 * v[2],
          -0.921178396165 * v[0] + 1.875929983695 * v[1] + 0.045248412470 * v[2],
          0.052881292876 * v[0] - 0.204011206124 * v[1] + 1.151129913248 * v[2]};
    for (double& t : rgb)
        t = std::clamp(t, 0.0, 1.0);
    return lab(rgb);
}

/// Magnitude of the first or second derivative of luminance.
double feature(const RgbImage& image, int x, int y, double ppd, int order) {
    const double s = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3.0 * s));
    const auto weight = [&](double along, double across) {
        const double g = std::exp(-(along * along + across * across) / (2 * s * s));
        return order == 1 ? -along * g : (along * along / (s * s) - 1) * g;
    };
    double positive = 0, negative = 0;
    for (int i = -radius; i <= radius; ++i)
        for (int j = -radius; j <= radius; ++j)
            (weight(i, j) > 0 ? positive : negative) += std::abs(weight(i, j));
    double dx = 0, dy = 0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const int u = std::clamp(x + i, 0, image.width - 1), v = std::clamp(y + j, 0, image.height - 1);
            const double value = (opponent(image.pixels[static_cast<std::size_t>(v * image.width + u)])[0] + 16) / 116;
            dx += weight(i, j) / (weight(i, j) > 0 ? positive : negative) * value;
            dy += weight(j, i) / (weight(j, i) > 0 ? positive : negative) * value;
        }
    return std::hypot(dx, dy);
}

double colour_error(const V& p, const V& q) {
    const double most = distance(lab({0, 1, 0}), lab({0, 0, 1})), knee = 0.4 * most, d = distance(p, q);
    return d < knee ? 0.95 / knee * d : 0.95 + (d - knee) / (most - knee) * 0.05;
}

}  // namespace

double direct_flip(const RgbImage& image, const RgbImage& reference, int x, int y, double ppd) {
    const double colour = colour_error(perceived_colour(image, x, y, ppd), perceived_colour(reference, x, y, ppd));
    double difference = 0;
    for (const int order : {1, 2})
        difference =
            std::max(difference, std::abs(feature(image, x, y, ppd, order) - feature(reference, x, y, ppd, order)));
    return std::pow(colour, 1 - std::sqrt(difference / std::sqrt(2.0)));
}

}  // namespace treefarm
