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
constexpr double kTail = 0.025;            ///< probability on each side of a 95 % interval
constexpr std::size_t kMostBlocks = 1024;  ///< limits the cost for large images
constexpr double kFewPixels = 100;

/// Two estimates of the summed squared error of a block. The pixels of a block are scattered over the image: their
/// errors are independent anywhere, but noisy pixels are neighbours, and one noisy block among quiet ones would say
/// little about its own spread.
struct BlockError {
    double by_variance = 0;  ///< expected from the variances
    double by_halves = 0;    ///< ((a - b) / 2)^2 of the two halves: as uncertain as the squared error itself
};

double channel_sum(const Rgb64& v) {
    return v.x + v.y + v.z;
}

/// Permutes the bits of a pixel's index (the finaliser of splitmix64).
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

/// Ratios by_halves / by_variance over resampled blocks, sorted. Blocks without variance are skipped.
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

/// Factor by which Student's t is wider than the normal distribution at 97.5 % (Cornish-Fisher), with the effective
/// number of blocks as degrees of freedom. If a few blocks make up most of the spread, the spread is uncertain, and an
/// interval from it too narrow.
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

/// Effective number of pixels: of equal noise, so many would give an error with the same uncertainty.
double noisy_pixels(const CombinedImage& image) {
    double sum = 0, squares = 0;
    for (const Rgb64& variance : image.variance) {
        sum += channel_sum(variance);
        squares += channel_sum(variance) * channel_sum(variance);
    }
    return squares > 0 ? sum * sum / squares : 0;
}

/// Widens the interval if a few rare samples make up the whole error. The halves cannot show its spread then: each rare
/// sample is alone in its pixel, and the halves differ by as much as the estimate, whichever others were missed. The
/// interval becomes at least that of a variance of `pixels` normal numbers (chi-square by Wilson and Hilferty).
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
    // (error^2 - variance) has the spread of (halves' difference^2 - variance), which can be measured: both are squares
    // of half the sum or difference of the same two independent errors. Only the spread is taken from the latter.
    const std::vector<double> ratios = resampled_ratios(blocks, seed);
    const double centre = whole.by_halves / whole.by_variance;
    const double exponent = 0.5 * small_sample_factor(blocks, centre);  // 0.5: square root
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
