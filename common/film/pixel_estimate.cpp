// SPDX-License-Identifier: Apache-2.0
#include "common/film/pixel_estimate.h"

namespace treefarm {

void Moments::add(const Rgb& value) {
    ++n;
    const double fraction = 1.0 / n;
    for (int c = 0; c < 3; ++c) {
        const double deviation = static_cast<double>(value[c]) - mean[c];
        mean[c] += deviation * fraction;
        m2[c] += deviation * (static_cast<double>(value[c]) - mean[c]);
    }
}

Moments Moments::merge(const Moments& a, const Moments& b) {
    if (a.n == 0) return b;
    if (b.n == 0) return a;
    Moments whole;
    whole.n = a.n + b.n;
    const double fraction = static_cast<double>(b.n) / whole.n;
    for (int c = 0; c < 3; ++c) {
        const double difference = b.mean[c] - a.mean[c];
        whole.mean[c] = a.mean[c] + difference * fraction;
        whole.m2[c] = a.m2[c] + b.m2[c] + difference * difference * (a.n * fraction);
    }
    return whole;
}

PixelEstimate PixelEstimate::merge(const PixelEstimate& a, const PixelEstimate& b) {
    return {{Moments::merge(a.half[0], b.half[0]), Moments::merge(a.half[1], b.half[1])}};
}

}  // namespace treefarm
