// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/colour/spectra.h"

#include <algorithm>
#include <cmath>

#include "coordinator/input/colour/cie_1931.h"

namespace treefarm {
namespace {

using Rgb64 = Imath::Color3<double>;

/// Value at `wavelength` between samples `i` and `i + 1`.
double interpolate(const SpectrumSamples& samples, std::size_t i, double wavelength) {
    const auto& [w0, v0] = samples[i];
    const auto& [w1, v1] = samples[i + 1];
    return v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0);
}

}  // namespace

// ITU-R BT.709 primaries, white D65.
Rgb64 xyz_to_rgb(double x, double y, double z) {
    return {3.240479 * x - 1.537150 * y - 0.498535 * z, -0.969256 * x + 1.875991 * y + 0.041556 * z,
            0.055648 * x - 0.204043 * y + 1.057311 * z};
}

double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Imath::Color3<double> spectrum_to_rgb(const SpectrumSamples& samples, bool under_d65) {
    const CieTables& cie = cie_tables();
    // All knots: between two of them both spectrum and observer are linear, so Simpson's rule is exact (without D65).
    std::vector<double> knots;
    for (int w = CieTables::kFirst; w <= CieTables::kLast; ++w)
        knots.push_back(w);
    for (const auto& [w, value] : samples)
        if (w > CieTables::kFirst && w < CieTables::kLast) knots.push_back(w);
    std::sort(knots.begin(), knots.end());

    Rgb64 xyz(0.0);
    double normalization = 0.0;
    std::size_t segment = 0;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const double begin = knots[k], end = knots[k + 1], middle = 0.5 * (begin + end);
        if (!(end > begin)) continue;
        const auto entry = std::min(static_cast<std::size_t>(middle - CieTables::kFirst), CieTables::kCount - 2);
        while (segment + 2 < samples.size() && middle > samples[segment + 1].first)
            ++segment;
        const bool inside = middle > samples.front().first && middle < samples.back().first;
        const double nodes[3] = {begin, middle, end}, weights[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
        for (int i = 0; i < 3; ++i) {
            const double t = nodes[i] - (CieTables::kFirst + static_cast<double>(entry));
            const auto at = [&](const auto& table) { return table[entry] + t * (table[entry + 1] - table[entry]); };
            const double light = under_d65 ? at(cie.d65) : 1.0;
            const double weight = weights[i] * (end - begin) * light;
            normalization += weight * at(cie.y);
            if (inside)
                xyz += Rgb64(at(cie.x), at(cie.y), at(cie.z)) * (weight * interpolate(samples, segment, nodes[i]));
        }
    }
    xyz /= normalization;
    return xyz_to_rgb(xyz.x, xyz.y, xyz.z);
}

}  // namespace treefarm
