// SPDX-License-Identifier: Apache-2.0
#include "common/film/combine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/parallel.h"
#include "common/base/policy.h"
#include "common/film/trimmed_mean.h"

namespace treefarm {
namespace {

/// Limit of a pixel's variance in stuv_ppg, as in the authors' program.
constexpr double kVarianceClamp = 1e4;

/// Least number of pixels per thread.
constexpr std::size_t kLeastCombined = 1024;

/// Consecutive passes with one tree and one way of sampling emitters.
using Alike = std::span<const PassResult>;

/// The passes from number `first` on that are alike.
Alike alike_from(std::span<const PassResult> passes, std::size_t first) {
    std::size_t end = first + 1;
    while (end < passes.size() && passes[end].same_tree && !passes[end].new_technique)
        ++end;
    return passes.subspan(first, end - first);
}

std::uint32_t spp_of(Alike passes) {
    std::uint32_t spp = 0;
    for (const PassResult& pass : passes)
        spp += pass.spp;
    return spp;
}

/// Noise of one half of the samples, without the worst pixels: otherwise a rare sample in one half would cost its pass
/// all weight in the other half, which lacks it.
HalfNoise measure_half(Alike passes, std::size_t half) {
    const std::size_t count = passes.front().pixels.size();
    constexpr double kNone = -1;
    std::vector<double> variances(count, kNone);
    std::vector<std::uint32_t> samples(passes.size());
    for (std::size_t p = 0; p < count; ++p) {
        double squares = 0, freedom = 0;
        for (std::size_t k = 0; k < passes.size(); ++k) {
            const Moments& m = passes[k].pixels[p].half[half];
            samples[k] = std::max(samples[k], m.n);
            if (m.n < 2) continue;
            squares += luminance(m.m2);
            freedom += m.n - 1;
        }
        if (freedom > 0) variances[p] = squares / freedom;
    }
    std::erase(variances, kNone);
    HalfNoise noise{std::nullopt, std::move(samples)};
    if (!variances.empty()) noise.variance = trimmed_mean(std::move(variances));
    return noise;
}

SampleNoise measure_noise(Alike passes) {
    SampleNoise noise{passes.size(), {}};
    in_parts(2, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t half = begin; half < end; ++half)
            noise.half[half] = measure_half(passes, half);
    });
    return noise;
}

/// Whether passes are weighted by their noise. Without guiding all samples are equally good, and none is discarded.
bool weighs_by_noise(Combination method, bool guided) {
    return guided && method == Combination::inverse_variance;
}

/// Group of passes that are alike.
struct Group {
    Alike passes;
    SampleNoise noise;
};

SampleNoise noise_of(Alike passes) {
    const SampleNoise& known = passes.front().noise;
    return known.passes == passes.size() ? known : measure_noise(passes);
}

std::vector<Group> group_alike(std::span<const PassResult> passes) {
    std::vector<Group> groups;
    for (std::size_t first = 0; first < passes.size(); first += groups.back().passes.size()) {
        const Alike alike = alike_from(passes, first);
        groups.push_back({alike, noise_of(alike)});
    }
    return groups;
}

void normalise(std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights)
        sum += w;
    if (sum > 0)
        for (double& w : weights)
            w /= sum;
    else
        weights.back() = 1.0;
}

std::vector<double> fixed_weights(std::span<const PassResult> passes, bool guided) {
    std::vector<double> weights;
    for (const PassResult& pass : passes) {
        double weight = 0;
        for (const PassPart& part : pass.parts)
            weight += fixed_weight(part.spp, part.spp_before, guided);
        weights.push_back(pass.parts.empty() ? fixed_weight(pass.spp, pass.spp_before, guided) : weight);
    }
    normalise(weights);
    return weights;
}

/// Consecutive passes whose samples count as equally noisy.
struct Level {
    std::size_t first, end;
    double spp, variance;
    bool apart;  ///< sampled by another technique than the level before
};

/// Appends a level under the assumption that each tree is at least as good as the one before. If it measures noisier,
/// the measurement is at fault: a short pass has not met the rare samples that a long one has. Both levels are then
/// pooled (isotonic regression by pooling adjacent violators). The same holds for unguided passes after guided ones,
/// which follow where guiding did not pay: guided samples may be better there, but their small number loses less by
/// equal weight than by the weights that their passes report.
void add_level(std::vector<Level>& levels, Level last) {
    while (!levels.empty() && !last.apart && last.variance >= levels.back().variance) {
        const Level before = levels.back();
        levels.pop_back();
        const double spp = before.spp + last.spp;
        const double variance = (before.spp * before.variance + last.spp * last.variance) / spp;
        last = {before.first, last.end, spp, variance, before.apart};
    }
    levels.push_back(last);
}

/// Weights of the samples of one half, by the inverse variance that the other half, `half`, reports.
std::vector<double> inverse_variance_weights(std::span<const PassResult> passes, const std::vector<Group>& groups,
                                             int half, bool guided) {
    std::vector<Level> levels;
    // If guiding was given up, no tree was better than another: passes too short to measure take the noise of the next
    // one, or of the last.
    const bool young_count = !passes.back().guided;
    std::vector<std::uint32_t> samples(passes.size(), 0);  // of passes that count
    bool apart = true;
    std::size_t first = 0, level_begin = 0;
    for (const Group& group : groups) {
        const std::size_t end = first + group.passes.size();
        const std::optional<double>& variance = group.noise.half[std::size_t(half)].variance;
        const std::uint32_t spp = spp_of(group.passes);
        apart = apart || group.passes.front().new_technique;
        const bool known = variance && spp >= tuned<std::uint32_t>("schedule.least_weighed_spp");
        if (known || young_count)
            std::ranges::copy(group.noise.half[std::size_t(1 - half)].samples, samples.begin() + std::ptrdiff_t(first));
        if (known) {
            if (!(*variance > 0))
                return fixed_weights(passes, guided);  // a tree without noise: no weight can be derived
            add_level(levels, {level_begin, end, double(spp), *variance, apart});
            apart = false;
            level_begin = end;
        }
        first = end;
    }
    if (levels.empty()) return fixed_weights(passes, guided);
    if (young_count) levels.back().end = passes.size();
    std::vector<double> weights(passes.size(), 0.0);
    for (const Level& level : levels)
        for (std::size_t k = level.first; k < level.end; ++k)
            weights[k] = samples[k] / level.variance;
    normalise(weights);
    return weights;
}

/// Estimated variance of one sample of a pass in a pixel; `longest` is the pixel in the longest pass. From four samples
/// on the estimate ignores the difference between the halves, which error_estimate.cpp uses. For a single sample it is
/// the squared distance from the longest pass.
Rgb64 sample_variance(const PixelEstimate& pixel, const PixelEstimate& longest) {
    const std::uint32_t n = pixel.half[0].n + pixel.half[1].n;
    if (n >= tuned<std::uint32_t>("schedule.least_weighed_spp"))
        return (pixel.half[0].m2 + pixel.half[1].m2) / static_cast<double>(n - 2);
    if (n >= 2) return pixel.whole().sample_variance();
    const Moments reference = longest.whole();
    if (reference.n < 2) return Rgb64(0.0);
    const Rgb64 distance = pixel.whole().mean - reference.mean;
    return distance * distance * (static_cast<double>(reference.n) / (reference.n + 1));
}

/// The passes at the end that share one tree.
Alike passes_of_last_tree(std::span<const PassResult> passes) {
    std::size_t first = passes.size() - 1;
    while (first > 0 && passes[first].same_tree)
        --first;
    return passes.subspan(first);
}

const PassResult& longest_pass(std::span<const PassResult> passes) {
    return *std::max_element(passes.begin(), passes.end(),
                             [](const PassResult& a, const PassResult& b) { return a.spp < b.spp; });
}

/// One pixel of an image.
struct Estimate {
    Rgb64 mean{0.0}, variance{0.0};
};

/// Weighted mean of one half of a pixel's samples. A pass without samples in this half loses its weight; if only passes
/// of weight zero have samples, these weigh equally.
Estimate combine_half(std::span<const PassResult> passes, const std::vector<double>& weights, int half, std::size_t p,
                      const PassResult& longest) {
    Estimate pixel;
    double sum = 0;
    const auto add = [&](const PassResult& pass, double weight) {
        const Moments& m = pass.pixels[p].half[half];
        if (m.n == 0) return;
        sum += weight;
        pixel.mean += m.mean * weight;
        const Rgb64 variance = m.n >= 2 ? m.sample_variance() : sample_variance(pass.pixels[p], longest.pixels[p]);
        pixel.variance += variance * (weight * weight / m.n);
    };
    for (std::size_t k = 0; k < passes.size(); ++k)
        if (weights[k] > 0) add(passes[k], weights[k]);
    if (!(sum > 0))
        for (const PassResult& pass : passes)
            add(pass, pass.pixels[p].half[half].n);
    if (!(sum > 0)) return {};
    pixel.mean /= sum;
    pixel.variance /= sum * sum;
    return pixel;
}

/// The image of each half with its own weights, and their average.
CombinedImage combine_halves(std::span<const PassResult> passes, const std::array<std::vector<double>, 2>& weights) {
    CombinedImage image;
    const std::size_t count = passes.front().pixels.size();
    for (std::vector<Rgb64>* values : {&image.mean, &image.variance, &image.half[0], &image.half[1]})
        values->resize(count);
    const PassResult& longest = longest_pass(passes);
    in_parts(count, kLeastCombined, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const Estimate a = combine_half(passes, weights[0], 0, p, longest);
            const Estimate b = combine_half(passes, weights[1], 1, p, longest);
            image.half[0][p] = a.mean;
            image.half[1][p] = b.mean;
            image.mean[p] = (a.mean + b.mean) * 0.5;
            image.variance[p] = (a.variance + b.variance) * 0.25;
        }
    });
    for (std::size_t k = 0; k < passes.size(); ++k)
        image.weight.push_back(0.5 * (weights[0][k] + weights[1][k]));
    return image;
}

/// The image from whole passes. A pass of one sample has no halves; a run of such passes only is their weighted mean. A
/// pass without samples of a pixel loses its weight there.
CombinedImage combine_whole(std::span<const PassResult> passes, const std::vector<double>& weights) {
    CombinedImage image;
    const std::size_t count = passes.front().pixels.size();
    image.mean.assign(count, Rgb64(0.0));
    image.variance.assign(count, Rgb64(0.0));
    const PassResult& longest = longest_pass(passes);
    in_parts(count, kLeastCombined, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            double sum = 0, left_out = 0;
            for (std::size_t k = 0; k < passes.size(); ++k) {
                const Moments m = passes[k].pixels[p].whole();
                (m.n == 0 ? left_out : sum) += weights[k];
                if (m.n == 0) continue;
                image.mean[p] += m.mean * weights[k];
                image.variance[p] +=
                    sample_variance(passes[k].pixels[p], longest.pixels[p]) * (weights[k] * weights[k] / m.n);
            }
            if (left_out == 0 || !(sum > 0)) continue;
            image.mean[p] /= sum;
            image.variance[p] /= sum * sum;
        }
    });
    image.half[0] = image.half[1] = image.mean;
    image.weight = weights;
    return image;
}

/// Weights of the original passes; the weight of a merged pass is divided by samples.
std::vector<double> weights_of_parts(std::span<const PassResult> passes, const std::vector<double>& weights) {
    std::vector<double> of_parts;
    for (std::size_t k = 0; k < passes.size(); ++k) {
        if (passes[k].parts.empty()) of_parts.push_back(weights[k]);
        for (const PassPart& part : passes[k].parts)
            of_parts.push_back(weights[k] * part.spp / passes[k].spp);
    }
    return of_parts;
}

}  // namespace

double fixed_weight(std::uint32_t spp, std::uint32_t spp_before, bool guided) {
    // The quality of a pass grows with the samples that its tree was learned from; the first, untrained pass counts a
    // little.
    return spp * (guided ? std::sqrt(static_cast<double>(std::max(spp_before, 1u))) : 1.0);
}

void remember_noise(std::span<PassResult> passes, Combination method, bool guided) {
    if (!weighs_by_noise(method, guided)) return;
    for (std::size_t first = 0; first < passes.size(); first += passes[first].noise.passes)
        passes[first].noise = noise_of(alike_from(passes, first));
}

CombinedImage combine_passes(std::span<const PassResult> passes, Combination method, bool guided) {
    if (passes.empty()) return {};
    if (method == Combination::last && guided) {
        passes = passes_of_last_tree(passes);
        guided = false;
    }
    const std::uint32_t longest = longest_pass(passes).spp;
    if (longest < 2) return combine_whole(passes, fixed_weights(passes, guided));  // none of these is merged

    // Preset weights apply to both halves. Variances cross over: those of half A weigh half B, so that no weight
    // depends on the samples it multiplies.
    CombinedImage image;
    if (weighs_by_noise(method, guided)) {
        const std::vector<Group> groups = group_alike(passes);
        image = combine_halves(passes, {inverse_variance_weights(passes, groups, 1, guided),
                                        inverse_variance_weights(passes, groups, 0, guided)});
    } else {
        const std::vector<double> fixed = fixed_weights(passes, guided);
        image = combine_whole(passes, fixed);
        CombinedImage halves = combine_halves(passes, {fixed, fixed});
        image.half[0] = std::move(halves.half[0]);
        image.half[1] = std::move(halves.half[1]);
    }
    image.longest_pass = longest;
    image.weight = weights_of_parts(passes, image.weight);
    return image;
}

PassVariance pass_variance(std::span<const PixelEstimate> pixels) {
    PassVariance result;
    std::vector<double> variances;
    variances.reserve(pixels.size());
    for (const PixelEstimate& pixel : pixels) {
        const Moments m = pixel.whole();
        if (m.n == 0) continue;
        const Rgb64 per_channel = m.sample_variance();
        const double variance = luminance(per_channel);
        variances.push_back(variance);
        result.stuv += variance;
        result.mse_of_sample += (per_channel.x + per_channel.y + per_channel.z) / 3.0;
        if (m.n >= 2) {
            const double n = m.n;
            const Rgb64 second_moment = m.m2 / n + m.mean * m.mean;
            const Rgb64 theirs = second_moment - m.mean * m.mean / n;
            result.stuv_ppg += n * std::min(luminance(theirs), kVarianceClamp) / (n - 1);
        }
    }
    if (variances.empty()) return result;
    const auto count = static_cast<double>(variances.size());
    result.stuv /= count;
    result.mse_of_sample /= count;
    result.stuv_ppg /= count;
    result.stuv_trimmed = trimmed_mean(std::move(variances));
    return result;
}

}  // namespace treefarm
