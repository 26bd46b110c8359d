// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/flip/measure_flip.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace treefarm {

namespace {

struct FinitePair {
    RgbImage image, reference;
    std::vector<std::size_t> replaced;  ///< pixels that are not finite in both images
};

FinitePair replace_invalid(const RgbImage& image, const RgbImage& reference) {
    FinitePair pair{image, reference, {}};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (is_valid(image.pixels[i]) && is_valid(reference.pixels[i])) continue;
        if (!is_valid(reference.pixels[i])) pair.reference.pixels[i] = Rgb(0.0f);
        pair.image.pixels[i] = pair.reference.pixels[i];
        pair.replaced.push_back(i);
    }
    return pair;
}

Plane without(Plane map, const std::vector<std::size_t>& pixels) {
    for (const std::size_t i : pixels)
        map.values[i] = static_cast<float>(ErrorMetrics::kUndefined);
    return map;
}

}  // namespace

FlipFigures flip_figures(const Plane& map) {
    std::vector<float> values = map.values;
    std::erase_if(values, [](float v) { return std::isnan(v); });
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    double part = 0.0;
    const auto half = std::find_if(values.begin(), values.end() - 1, [&](float v) {
        part += v;
        return part >= 0.5 * sum;
    });
    return {sum / static_cast<double>(values.size()), *half, values.back()};
}

FlipMetrics measure_flip(const RgbImage& image, const RgbImage& reference, double ppd) {
    require_same_size(image, reference);
    const FinitePair pair = replace_invalid(image, reference);
    FlipMetrics m;
    m.ppd = ppd;
    m.exposures = exposure_range(image, reference);
    m.hdr_map = without(hdr_flip(pair.image, pair.reference, m.exposures, ppd), pair.replaced);
    m.hdr = flip_figures(m.hdr_map);
    m.ldr = flip_figures(without(flip(pair.image, pair.reference, ppd), pair.replaced));
    return m;
}

}  // namespace treefarm
