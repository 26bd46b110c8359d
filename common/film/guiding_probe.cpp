// SPDX-License-Identifier: Apache-2.0
#include "common/film/guiding_probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/plan/policy.h"

namespace treefarm {
namespace {

constexpr double kLeastGain = 1e-9;  ///< unguided samples have no noise at all

/// The image's luminance squared, blurred and with a floor: what a pixel's variance is relative to.
class Levels {
  public:
    Levels(std::span<const Rgb64> image, std::size_t width)
        : width_(width), columns_((width + kPolicy.guiding.probe_block - 1) / kPolicy.guiding.probe_block) {
        const std::size_t rows = (image.size() + width - 1) / width;
        std::vector<double> counts((rows + kPolicy.guiding.probe_block - 1) / kPolicy.guiding.probe_block * columns_);
        squares_.resize(counts.size());
        double sum = 0;
        for (std::size_t p = 0; p < image.size(); ++p) {
            const double y = luminance(image[p]);
            sum += y;
            squares_[block(p)] += y;
            counts[block(p)] += 1;
        }
        mean_ = sum / static_cast<double>(std::max<std::size_t>(image.size(), 1));
        for (std::size_t b = 0; b < squares_.size(); ++b) {
            const double level = squares_[b] / counts[b];
            squares_[b] = level * level + kPolicy.guiding.probe_floor * kPolicy.guiding.probe_floor * mean_ * mean_;
        }
    }

    double mean() const { return mean_; }
    double square_at(std::size_t p) const { return squares_[block(p)]; }

  private:
    std::size_t block(std::size_t p) const {
        return p / width_ / kPolicy.guiding.probe_block * columns_ + p % width_ / kPolicy.guiding.probe_block;
    }

    std::size_t width_, columns_;
    std::vector<double> squares_;
    double mean_ = 0;
};

struct Weighted {
    double value, weight;
};

/// Weighted mean without the largest, one of so many and one at least; changes their order.
double trimmed(std::vector<Weighted>& values, std::size_t one_of) {
    const auto kept = static_cast<std::ptrdiff_t>(values.size() - std::max<std::size_t>(values.size() / one_of, 1));
    const auto end = values.begin() + kept;
    std::nth_element(values.begin(), end, values.end(),
                     [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double sum = 0, weight = 0;
    for (auto v = values.begin(); v != end; ++v) {
        sum += v->value * v->weight;
        weight += v->weight;
    }
    return sum / weight;
}

double per_path(std::uint64_t rays, std::uint64_t paths) {
    return paths > 0 ? static_cast<double>(rays) / static_cast<double>(paths) : 0.0;
}

}  // namespace

ProbePixels::ProbePixels(std::size_t film_pixels, std::uint32_t pass) {
    constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
    const std::uint64_t fraction = kPolicy.guiding.probe_pixels * kAll / std::max<std::uint64_t>(film_pixels, 1);
    count_ = static_cast<std::uint32_t>(std::clamp(fraction, kAll / 128, kAll / 8));
    first_ = pass % 8 * count_;
}

void ProbesSetAside::take_out(std::span<PixelEstimate> pixels, std::uint32_t pass, std::size_t index) {
    const ProbePixels probe(pixels.size(), pass);
    for (std::size_t p = 0; p < pixels.size(); ++p)
        if (probe.holds(static_cast<std::uint32_t>(p))) probes_.push_back({index, p, std::exchange(pixels[p], {})});
}

void ProbesSetAside::follow_fold(std::size_t first) {
    for (Probe& probe : probes_)
        if (probe.index > first) --probe.index;
}

bool ProbesSetAside::fits(std::size_t passes, std::size_t pixels) const {
    return std::all_of(probes_.begin(), probes_.end(),
                       [&](const Probe& probe) { return probe.index < passes && probe.pixel < pixels; });
}

void ProbesSetAside::put_back(std::span<PassResult> passes) {
    for (const Probe& probe : std::exchange(probes_, {})) {
        PassResult& pass = passes[probe.index];
        PixelEstimate& pixel = pass.pixels[probe.pixel];  // empty, but for passes that were merged
        pass.stored.clear();
        pixel = PixelEstimate::merge(pixel, probe.estimate);
    }
    for (PassResult& pass : passes)
        pass.noise = {};
}

void GuidingProbe::add(std::span<const PixelEstimate> pixels, const TraceStats& stats, std::uint32_t pass) {
    const ProbePixels probe(pixels.size(), pass);
    for (std::uint32_t p = 0; p < pixels.size(); ++p) {
        const Moments whole = pixels[p].whole();
        if (probe.holds(p) && whole.n >= 2)
            unguided_.push_back({p, whole.n, luminance(whole.sample_variance()), luminance(whole.mean)});
    }
    paths_ += stats.probe_paths;
    rays_ += stats.probe_rays;
}

GuidingGain GuidingProbe::gain(std::span<const PixelEstimate> pixels, const TraceStats& stats, std::uint32_t pass,
                               std::span<const Rgb64> image, std::size_t width) const {
    if (unguided_.size() < kPolicy.guiding.least_probe_pixels) return {};
    const Levels levels(image, width);
    if (!(levels.mean() > 0)) return {};
    std::vector<Weighted> guided, unguided;
    const ProbePixels probe = stats.probe_paths > 0 ? ProbePixels(pixels.size(), pass) : ProbePixels();
    for (std::uint32_t p = 0; p < pixels.size(); ++p)
        if (const Moments whole = pixels[p].whole(); whole.n >= 2 && !probe.holds(p))
            guided.push_back({luminance(whole.sample_variance()) / levels.square_at(p), 1.0});
    double found = 0, samples = 0;
    for (const Unguided& u : unguided_) {
        const double square = levels.square_at(u.pixel);
        unguided.push_back({u.variance / square, u.samples - 1.0});
        found += u.samples * std::min(u.mean / std::sqrt(square), kPolicy.guiding.probe_evenly);
        samples += u.samples;
    }
    if (guided.size() < kPolicy.guiding.least_probe_pixels) return {};
    const double rays = per_path(stats.rays - stats.probe_rays, stats.paths - stats.probe_paths);
    const auto gain_without_one_of = [&](std::size_t one_of) {
        const double with = trimmed(guided, one_of) * rays * kPolicy.guiding.ray_cost;
        const double without = trimmed(unguided, one_of) * per_path(rays_, paths_);
        return with > 0 ? std::max(without / with, kLeastGain) : 0;
    };
    return {gain_without_one_of(1000), gain_without_one_of(100), found / samples};
}

}  // namespace treefarm
