#include "common/film/guiding_probe.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace treefarm {
namespace {

constexpr double kTrimmed = 0.001;
constexpr double kFloor = 0.1;       ///< of the image's mean
constexpr double kLeastGain = 1e-9;  ///< unguided samples have no noise at all
/// Fewer pixels tell nothing.
constexpr std::size_t kLeastPixels = 64;

double luminance(const Rgb64& c) {
    return 0.212671 * c.x + 0.71516 * c.y + 0.072169 * c.z;
}

double trimmed_mean(std::vector<double>& values) {
    const std::size_t kept = values.size() - static_cast<std::size_t>(kTrimmed * static_cast<double>(values.size()));
    std::sort(values.begin(), values.end());
    return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
           static_cast<double>(kept);
}

}  // namespace

double guiding_gain(std::span<const PixelEstimate> pixels, std::span<const Rgb64> image, const ProbeCounts& guided,
                    const ProbeCounts& unguided) {
    double mean = 0;
    for (const Rgb64& c : image)
        mean += luminance(c);
    mean /= static_cast<double>(std::max<std::size_t>(image.size(), 1));
    if (!(mean > 0)) return 0;
    std::vector<double> of_guided, of_unguided;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const Moments whole = pixels[p].whole();
        if (whole.n < 2) continue;
        const double level = luminance(image[p]), floor = kFloor * mean;
        const double variance = luminance(whole.sample_variance()) / (level * level + floor * floor);
        (is_probe_pixel(static_cast<std::uint32_t>(p)) ? of_unguided : of_guided).push_back(variance);
    }
    if (std::min(of_guided.size(), of_unguided.size()) < kLeastPixels) return 0;
    const double with = trimmed_mean(of_guided) * guided.rays_per_path() * kGuidedRayCost;
    const double without = trimmed_mean(of_unguided) * unguided.rays_per_path();
    return with > 0 ? std::max(without / with, kLeastGain) : 0;
}

}  // namespace treefarm
