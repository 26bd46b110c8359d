// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/tail_report.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>

#include "coordinator/words/noise_share.h"

namespace treefarm {
namespace {

constexpr double kNoisePart = 0.4;          ///< fraction of an image's noise whose fewest pixels are counted
constexpr double kToldShare = 0.001;        ///< fraction of all pixels: fewer that carry so much noise are reported
constexpr std::size_t kLeastPixels = 4096;  ///< in smaller images a thousandth is only a few pixels

/// Worst samples of the passes that contribute to the image, which are the last ones.
TailSamples samples_of_image(const CombinedImage& image, std::span<const PassReport> passes) {
    TailSamples all;
    const std::size_t count = std::min(image.weight.size(), passes.size());
    const std::span<const PassReport> used = passes.last(count);
    for (std::size_t k = 0; k < count; ++k)
        for (TailSample sample : used[k].stats.tails.worst) {
            const double weight = image.weight[image.weight.size() - count + k];
            sample.noise = static_cast<float>(sample.noise * weight * weight);
            if (sample.noise > 0.0f) all.add(sample);
        }
    return all;
}

/// Whether the camera sees the light directly: a lamp's edge, or the environment.
bool is_seen_directly(const LightOrigin& origin) {
    return origin.vertices <= 1 && (origin.found == LightFound::met || origin.found == LightFound::sky_met);
}

std::string main_origin(const TailSamples& samples) {
    std::map<std::string, double> noise;
    for (const TailSample& sample : samples.worst)
        if (!is_seen_directly(sample.origin)) noise[words(sample.origin)] += static_cast<double>(sample.noise);
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto most = std::max_element(noise.begin(), noise.end(), less);
    return most == noise.end() ? "" : most->first;
}

}  // namespace

TailReport tail_report(const CombinedImage& image, std::span<const PassReport> passes) {
    TailReport report;
    if (image.longest_pass < 2) return report;
    report.share = noise_share(image.variance, kNoisePart);
    report.worst = samples_of_image(image, passes);
    double seen = 0, others = 0;
    for (const TailSample& sample : report.worst.worst)
        (is_seen_directly(sample.origin) ? seen : others) += static_cast<double>(sample.noise);
    report.origin = main_origin(report.worst);
    report.stands_out =
        report.share && *report.share < kToldShare && others > seen && image.variance.size() >= kLeastPixels;
    return report;
}

std::string tail_text(const TailReport& tails) {
    return fmt::format("fireflies: {:.0f} % of the noise is in {:.2g} % of the pixels ({})", 100 * kNoisePart,
                       100 * tails.share.value_or(0), tails.origin);
}

std::string tail_command(const TailReport& tails, const std::string& debug_command, const std::string& debug_options) {
    const auto at = std::find_if(tails.worst.worst.begin(), tails.worst.worst.end(),
                                 [](const TailSample& sample) { return !is_seen_directly(sample.origin); });
    const TailSample& worst = at == tails.worst.worst.end() ? tails.worst.worst.front() : *at;
    return fmt::format("the worst firefly, pixel ({}, {}), vertex by vertex: {} {},{},{},{}{}", worst.x, worst.y,
                       debug_command, worst.pass + 1, worst.x, worst.y, worst.sample, debug_options);
}

}  // namespace treefarm
