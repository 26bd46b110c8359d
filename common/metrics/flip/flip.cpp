// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/flip/flip.h"

#include <algorithm>
#include <cmath>

#include "common/metrics/flip/colour.h"

namespace treefarm {

namespace {

// Andersson et al. 2020.
constexpr float kColourExponent = 0.7f;  ///< q_c: compresses large colour differences
constexpr float kKnee = 0.4f;            ///< p_c: position of the knee, as a share of the greatest difference
constexpr float kKneeValue = 0.95f;      ///< p_t: error at the knee
constexpr float kFeatureScale = 0.70710678f;

/// Image in the perceptual space of FLIP.
struct Percept {
    Plane lightness, a, b;  ///< CIELAB with Hunt effect, blurred by contrast sensitivity
    Plane edges, points;    ///< magnitudes of the first and second derivative of luminance
};

struct Opponent {
    Plane y, cx, cz;
};

Vec3 clamped(const Vec3& c) {
    return {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)};
}

Opponent opponent_planes(const RgbImage& image) {
    Opponent planes{Plane(image.width, image.height), Plane(image.width, image.height),
                    Plane(image.width, image.height)};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Vec3 opponent = rgb_to_opponent(clamped(image.pixels[i]));
        planes.y.values[i] = opponent.x;
        planes.cx.values[i] = opponent.y;
        planes.cz.values[i] = opponent.z;
    }
    return planes;
}

void perceive_colour(const Opponent& planes, const SensitivityKernels& k, Percept& percept) {
    percept.lightness = filter_separable(planes.y, k.y, k.y);
    percept.a = filter_separable(planes.cx, k.cx, k.cx);
    percept.b = filter_separable(planes.cz, k.cz_narrow, k.cz_narrow);
    const Plane wide = filter_separable(planes.cz, k.cz_wide, k.cz_wide);
    for (std::size_t i = 0; i < wide.values.size(); ++i) {
        float &lightness = percept.lightness.values[i], &a = percept.a.values[i], &b = percept.b.values[i];
        const Vec3 lab = rgb_to_hunt_lab(clamped(opponent_to_rgb({lightness, a, b + wide.values[i]})));
        lightness = lab.x;
        a = lab.y;
        b = lab.z;
    }
}

Plane magnitude(Plane x, const Plane& y) {
    for (std::size_t i = 0; i < x.values.size(); ++i)
        x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
    return x;
}

void perceive_features(Plane luminance, const FeatureKernels& k, Percept& percept) {
    for (float& y : luminance.values)
        y = (y + 16.0f) / 116.0f;
    percept.edges =
        magnitude(filter_separable(luminance, k.first, k.gaussian), filter_separable(luminance, k.gaussian, k.first));
    percept.points =
        magnitude(filter_separable(luminance, k.second, k.gaussian), filter_separable(luminance, k.gaussian, k.second));
}

Percept perceive(const RgbImage& image, double ppd) {
    Opponent planes = opponent_planes(image);
    Percept percept;
    perceive_colour(planes, sensitivity_kernels(ppd), percept);
    perceive_features(std::move(planes.y), feature_kernels(ppd), percept);
    return percept;
}

float compressed_distance(const Vec3& p, const Vec3& q) {
    return std::pow(hyab_distance(p, q), kColourExponent);
}

/// Greatest colour distance on a screen: from green to blue.
float greatest_distance() {
    return compressed_distance(rgb_to_hunt_lab({0.0f, 1.0f, 0.0f}), rgb_to_hunt_lab({0.0f, 0.0f, 1.0f}));
}

/// Colour error: two linear pieces over [0, greatest] that meet at the knee.
float colour_error(float distance, float greatest) {
    const float knee = kKnee * greatest;
    if (distance < knee) return distance * (kKneeValue / knee);
    return kKneeValue + (distance - knee) / (greatest - knee) * (1.0f - kKneeValue);
}

}  // namespace

Plane flip(const RgbImage& image, const RgbImage& reference, double ppd) {
    const Percept p = perceive(image, ppd), q = perceive(reference, ppd);
    const float greatest = greatest_distance();
    Plane result(image.width, image.height);
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const float distance = compressed_distance({p.lightness.values[i], p.a.values[i], p.b.values[i]},
                                                   {q.lightness.values[i], q.a.values[i], q.b.values[i]});
        const float feature = std::max(std::abs(p.edges.values[i] - q.edges.values[i]),
                                       std::abs(p.points.values[i] - q.points.values[i]));
        // The exponent of the feature difference is q_f = 1/2.
        result.values[i] = std::pow(colour_error(distance, greatest), 1.0f - std::sqrt(kFeatureScale * feature));
    }
    return result;
}

}  // namespace treefarm
