#pragma once

#include <cstdint>
#include <span>

#include "common/film/pixel_estimate.h"
#include "common/film/trace_stats.h"

namespace treefarm {

/// Whether guiding pays, measured by the render itself: in probe passes an eighth of the pixels, chosen by a hash, is
/// rendered unguided, and what samples and rays gave there is held against the others.

/// Whether a pixel (row * width + column) is rendered unguided in probe passes.
inline bool is_probe_pixel(std::uint32_t pixel) {
    return (pixel * 0x9e3779b9u) >> 29 == 0;
}

/// Rays of a probe pass and paths that they belong to.
struct ProbeCounts {
    std::uint64_t paths = 0, rays = 0;
    double rays_per_path() const { return paths > 0 ? static_cast<double>(rays) / static_cast<double>(paths) : 0.0; }
};

/// How much more a ray of a guided path costs than one of an unguided path: 1.12 to 1.49 was measured, by scene
/// (docs/guiding.md, "auto"); what is chosen favours guiding. A constant, not a clock: the decision is part of the
/// result.
inline constexpr double kGuidedRayCost = 1.2;

/// Relative variance times cost of unguided samples over that of guided ones: above 1 guiding pays. Variances are
/// relative to the square of the pixel's mean in `image` (with a floor of a tenth of the image's mean), the worst 0.1 %
/// of either kind left out. 0: too little is known. `pixels` of the pass, row by row.
double guiding_gain(std::span<const PixelEstimate> pixels, std::span<const Rgb64> image, const ProbeCounts& guided,
                    const ProbeCounts& unguided);
/// The same by the counts of the probe pass.
double guiding_gain(std::span<const PixelEstimate> pixels, std::span<const Rgb64> image, const TraceStats& stats);

}  // namespace treefarm
