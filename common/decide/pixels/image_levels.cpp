// SPDX-License-Identifier: Apache-2.0
#include "common/decide/pixels/image_levels.h"

#include <algorithm>
#include <numeric>

#include "common/decide/pixels/level_constants.h"
#include "common/film/trimmed_mean.h"
#include "common/math/level_block.h"

namespace treefarm {
namespace {

constexpr std::size_t kBlock = kLevelBlock;

std::size_t blocks_of(std::size_t pixels) {
    return (pixels + kBlock - 1) / kBlock;
}

std::vector<double> variances(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width) {
    std::vector<double> found;
    if (levels.inverse_levels.empty()) return found;
    found.reserve(pixels.size());
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const Moments whole = pixels[p].whole();
        if (whole.n < 2) continue;
        const auto inverse = static_cast<double>(levels.at(p, width));
        found.push_back(luminance(whole.sample_variance()) * inverse * inverse);
    }
    return found;
}

}  // namespace

bool ImageLevels::fits(std::size_t pixels, std::size_t width) const {
    return width > 0 && columns == blocks_of(width) &&
           inverse_levels.size() == columns * blocks_of((pixels + width - 1) / width);
}

float ImageLevels::at(std::size_t pixel, std::size_t width) const {
    return inverse_levels[level_block(pixel % width, pixel / width, columns)];
}

ImageLevels image_levels(std::span<const Rgb64> image, std::size_t width) {
    ImageLevels levels;
    if (image.empty()) return levels;
    levels.columns = blocks_of(width);
    const std::size_t rows = blocks_of((image.size() + width - 1) / width);
    std::vector<double> sums(rows * levels.columns), counts(sums.size());
    double all = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const std::size_t block = level_block(p % width, p / width, levels.columns);
        const double y = luminance(image[p]);
        sums[block] += y;
        counts[block] += 1;
        all += y;
    }
    const double least = tuned<policy::kLevels>("levels.least") * all / static_cast<double>(image.size());
    constexpr double kBlack = 1e-30;  // the reciprocal of less is no float
    if (!(least > kBlack)) return levels;
    for (std::size_t b = 0; b < sums.size(); ++b)
        levels.inverse_levels.push_back(static_cast<float>(1.0 / std::max(sums[b] / counts[b], least)));
    return levels;
}

double mean_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width) {
    const std::vector<double> found = variances(pixels, levels, width);
    return found.empty() ? 0 : std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size());
}

double relative_variance(std::span<const PixelEstimate> pixels, const ImageLevels& levels, std::size_t width) {
    std::vector<double> found = variances(pixels, levels, width);
    return found.empty() ? 0 : trimmed_mean(std::move(found));
}

}  // namespace treefarm
