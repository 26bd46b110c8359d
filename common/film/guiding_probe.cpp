#include "common/film/guiding_probe.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/film/trimmed_mean.h"

namespace treefarm {
namespace {

constexpr double kFloor = 0.1;       ///< of the image's mean
constexpr double kLeastGain = 1e-9;  ///< unguided samples have no noise at all
/// Fewer pixels tell nothing.
constexpr std::size_t kLeastPixels = 64;

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
    const double with = trimmed_mean(std::move(of_guided)) * guided.rays_per_path() * kGuidedRayCost;
    const double without = trimmed_mean(std::move(of_unguided)) * unguided.rays_per_path();
    return with > 0 ? std::max(without / with, kLeastGain) : 0;
}

double guiding_gain(std::span<const PixelEstimate> pixels, std::span<const Rgb64> image, const TraceStats& stats) {
    return guiding_gain(pixels, image, {stats.paths - stats.probe_paths, stats.rays - stats.probe_rays},
                        {stats.probe_paths, stats.probe_rays});
}

}  // namespace treefarm
