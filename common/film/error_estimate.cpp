// SPDX-License-Identifier: Apache-2.0
#include "common/film/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/policy.h"
#include "common/base/random.h"

namespace treefarm {
namespace {

constexpr std::size_t kResamples = 1000;
constexpr double kTail = 0.025;            ///< on each side of a 95 % interval
constexpr std::size_t kMostBlocks = 1024;  ///< so that the cost does not grow with the image
constexpr double kFewPixels = 100;

/// Two estimates of the summed squared error of a block of pixels. The pixels of a block are scattered over the image:
/// their errors are independent wherever they lie, but loud pixels lie together, and one loud block among quiet ones
/// says little of its own spread.
struct BlockError {
    double by_variance = 0;  ///< what the variances expect
    double by_halves = 0;    ///< ((a - b) / 2)^2 of the two halves: as uncertain as the squared error itself
};

double channel_sum(const Rgb64& v) {
    return v.x + v.y + v.z;
}

/// Spreads the bits of a pixel's index (the finaliser of splitmix64).
std::uint64_t scattered(std::uint64_t index) {
    index = (index + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
    index = (index ^ (index >> 27)) * 0x94d049bb133111ebu;
    return index ^ (index >> 31);
}

std::vector<BlockError> sum_blocks(const CombinedImage& image) {
    const std::size_t pixels = image.mean.size();
    std::vector<BlockError> blocks(std::min(pixels, kMostBlocks));
    for (std::size_t p = 0; p < pixels; ++p) {
        BlockError& block = blocks[scattered(p) % blocks.size()];
        const Rgb64 difference = (image.half[0][p] - image.half[1][p]) * 0.5;
        block.by_variance += channel_sum(image.variance[p]);
        block.by_halves += channel_sum(difference * difference);
    }
    return blocks;
}

BlockError total(const std::vector<BlockError>& blocks) {
    BlockError sum;
    for (const BlockError& block : blocks) {
        sum.by_variance += block.by_variance;
        sum.by_halves += block.by_halves;
    }
    return sum;
}

/// by_halves / by_variance over resampled blocks, sorted. Blocks of no variance drop out.
std::vector<double> resampled_ratios(const std::vector<BlockError>& blocks, std::uint64_t seed) {
    std::vector<double> ratios;
    ratios.reserve(kResamples);
    for (std::uint32_t resample = 0; resample < kResamples; ++resample) {
        BlockError sum;
        Draw numbers{};
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (i % numbers.size() == 0)
                numbers = draw({seed, static_cast<std::uint32_t>(i), resample}, 0, Stream::bootstrap);
            const std::uint64_t pick = (numbers[i % numbers.size()] * std::uint64_t{blocks.size()}) >> 32;
            sum.by_variance += blocks[pick].by_variance;
            sum.by_halves += blocks[pick].by_halves;
        }
        if (sum.by_variance > 0) ratios.push_back(sum.by_halves / sum.by_variance);
    }
    std::sort(ratios.begin(), ratios.end());
    return ratios;
}

/// Where few blocks make up most of the spread it is itself uncertain, and an interval from it too narrow: the factor
/// by which Student's t with as many degrees of freedom is wider than the normal distribution at 97.5 %
/// (Cornish-Fisher).
double small_sample_factor(const std::vector<BlockError>& blocks, double centre) {
    double squares = 0, fourth_powers = 0;
    for (const BlockError& block : blocks) {
        const double residual = block.by_halves - centre * block.by_variance;
        squares += residual * residual;
        fourth_powers += residual * residual * residual * residual;
    }
    if (!(fourth_powers > 0)) return 1;
    const double freedom = std::max(2.0, squares * squares / fourth_powers);
    return 1 + (1.21 + 1.44 / freedom) / freedom;
}

/// Number of pixels of equal noise that would make up an error that is known as badly.
double noisy_pixels(const CombinedImage& image) {
    double sum = 0, squares = 0;
    for (const Rgb64& variance : image.variance) {
        sum += channel_sum(variance);
        squares += channel_sum(variance) * channel_sum(variance);
    }
    return squares > 0 ? sum * sum / squares : 0;
}

/// Where a few rare samples are the whole error, the halves cannot show its spread: each of them is alone in its pixel,
/// and the difference of the halves is then as large as the estimate, whatever others were missed. The interval is at
/// least that of a variance by so many normal numbers (chi-square by Wilson and Hilferty).
void widen_for_few(ErrorEstimate& estimate, double pixels) {
    if (pixels >= kFewPixels) return;
    const auto quantile = [&](double z) {
        const double root = std::max(0.1, 1 - 2 / (9 * pixels) + z * std::sqrt(2 / (9 * pixels)));
        return root * root * root;  // over its expectation; at least that of one normal number, 1e-3
    };
    estimate.low = std::min(estimate.low, estimate.rmse / std::sqrt(quantile(1.96)));
    estimate.high = std::max(estimate.high, estimate.rmse / std::sqrt(quantile(-1.96)));
}

}  // namespace

double ErrorEstimate::relative(double error) const {
    if (error == 0) return 0;
    return mean > 0 ? error / mean : std::numeric_limits<double>::infinity();
}

ErrorEstimate estimate_error(const CombinedImage& image, std::uint64_t seed) {
    ErrorEstimate estimate;
    estimate.known = image.longest_pass >= 2;
    if (image.mean.empty()) return estimate;
    const auto count = static_cast<double>(image.mean.size());
    for (const Rgb64& mean : image.mean)
        estimate.mean += luminance(mean) / count;
    if (!estimate.known) return estimate;
    const std::vector<BlockError> blocks = sum_blocks(image);
    const BlockError whole = total(blocks);
    estimate.rmse = estimate.low = estimate.high = std::sqrt(whole.by_variance / (3 * count));
    estimate.has_interval = image.longest_pass >= tuned<std::uint32_t>("schedule.least_weighed_spp");
    if (!estimate.has_interval || !(whole.by_variance > 0 && whole.by_halves > 0)) return estimate;
    // (error^2 - variance) has the same spread as (halves' difference^2 - variance), which can be looked at: both are
    // squares of half the sum or difference of the same two independent errors. Only the spread is taken from there.
    const std::vector<double> ratios = resampled_ratios(blocks, seed);
    const double centre = whole.by_halves / whole.by_variance;
    const double exponent = 0.5 * small_sample_factor(blocks, centre);  // 0.5: of the root
    const auto at = [&](double fraction) {
        const double index = fraction * static_cast<double>(ratios.size() - 1);
        return std::pow(ratios[static_cast<std::size_t>(std::lround(index))] / centre, exponent);
    };
    estimate.low *= at(kTail);
    estimate.high *= at(1 - kTail);
    widen_for_few(estimate, noisy_pixels(image));
    return estimate;
}

}  // namespace treefarm
