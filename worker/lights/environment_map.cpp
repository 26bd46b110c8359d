#include "worker/lights/environment_map.h"

#include <algorithm>
#include <bit>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kTotal = std::uint32_t(1) << 31;

/// Shares of 2^31 in proportion to weights, at least 1 for each weight above 0: writes where each share begins, and the
/// end.
/// Returns false if all weights are 0.
bool share(const std::vector<double>& weights, std::uint32_t* begin) {
    double total = 0;
    std::uint32_t positive = 0;
    for (const double w : weights) {
        total += w;
        positive += w > 0;
    }
    const double spare = double(kTotal - positive);
    double sum = 0;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        begin[i] = total > 0 ? before + static_cast<std::uint32_t>(std::min(sum / total, 1.0) * spare) : 0;
        sum += weights[i];
        before += weights[i] > 0;
        // What rounding left over goes to the last entry that has a weight.
        if (before == positive) {
            std::fill(begin + i + 1, begin + weights.size(), kTotal);
            break;
        }
    }
    begin[weights.size()] = kTotal;
    return total > 0;
}

/// Index of the share that owns these bits, without a branch that nothing predicts.
std::size_t pick(const std::uint32_t* begin, std::size_t count, std::uint32_t bits) {
    const std::uint32_t* at = begin;
    for (; count > 1; count -= count / 2)
        at += at[count / 2] <= bits >> 1 ? count / 2 : 0;
    return static_cast<std::size_t>(at - begin);
}

/// Draws from [-1, 1] with a density of 1 - |x|.
float sample_tent(std::uint32_t bits16) {
    const float u = (static_cast<float>(bits16) + 0.5f) * 0x1p-15f;  // in (0, 2)
    const bool right = u > 1.0f;
    return negate_if(!right, 1.0f - std::sqrt(select(right, 2.0f - u, u)));
}

float mix(float a, float b, float t) {
    return a * (1.0f - t) + b * t;
}

}  // namespace

EnvironmentMap::EnvironmentMap(const EnvironmentEmitter& emitter, const TextureImage& image)
    : image_(&image),
      width_(image.width),
      height_(image.height),
      margin_(emitter.rows_at_poles && image.height > 1 ? 0.0f : 0.5f),
      half_turn_(static_cast<float>(height_ - 1) + 2.0f * margin_),
      scale_(emitter.scale),
      x_axis_(emitter.x_axis),
      y_axis_(emitter.y_axis),
      z_axis_(emitter.z_axis),
      // d(u) d(v) = d(solid angle) / (2 pi^2 sin(theta)).
      density_scale_(
          static_cast<float>(double(width_) * double(half_turn_) * 0x1p-62 / (2 * double(kPi) * double(kPi)))),
      rows_(static_cast<std::size_t>(height_) + 1),
      columns_(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1)),
      guide_bits_(std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(width_))) - 5)),
      guide_(static_cast<std::size_t>(height_) * ((std::size_t{1} << guide_bits_) + 1)) {
    const auto width = static_cast<std::size_t>(width_);
    double sum = 0, sines = 0;
    bool all_clean = true;
    std::vector<double> row_weights(static_cast<std::size_t>(height_)), weights(width);
    for (int y = 0; y < height_; ++y) {
        const auto row = static_cast<std::size_t>(y);
        // On a pole, where the sine is 0, a sixth of a row away: the share of the sphere that the texel shines from.
        const float from_pole =
            std::clamp(static_cast<float>(y) + margin_, 1.0f / 6.0f, half_turn_ - 1.0f / 6.0f) / half_turn_;
        const auto sine = double(sincos_turn(0.5f * from_pole).sin);
        sines += sine;
        for (int x = 0; x < width_; ++x) {
            const Rgb texel = clean_texel(x, y);
            all_clean = all_clean && texel == treefarm::texel(image, x, y);
            sum += sine * double(average(texel));
            row_weights[row] += weights[static_cast<std::size_t>(x)] = sine * double(luminance(texel));
        }
        if (on_pole(y)) row_weights[row] *= 0.5;
        std::uint32_t* const begin = &columns_[row * (width + 1)];
        share(weights, begin);
        const std::size_t entries = std::size_t{1} << guide_bits_;
        std::uint32_t* const guide = &guide_[row * (entries + 1)];
        for (std::size_t k = 0; k < entries; ++k)
            guide[k] = static_cast<std::uint32_t>(pick(begin, width, static_cast<std::uint32_t>((k << 32) / entries)));
        guide[entries] = static_cast<std::uint32_t>(width - 1);
    }
    clean_ = all_clean;
    mean_ = double(scale_) * sum / (sines * static_cast<double>(width_));
    if (!share(row_weights, rows_.data())) mean_ = 0;
}

Rgb EnvironmentMap::clean_texel(int x, int y) const {
    Rgb c = texel(*image_, x, y);
    if (clean_) return c;
    for (int i = 0; i < 3; ++i)
        if (!(c[i] > 0.0f && c[i] <= 1e30f)) c[i] = 0.0f;
    return c;
}

EnvironmentMap::Place EnvironmentMap::place(float u, float v) const {
    const float left = std::floor(u), top = std::floor(v);
    const int x = static_cast<int>(left), y = static_cast<int>(top);
    Place p;
    p.fx = u - left;
    p.fy = v - top;
    p.x0 = x < 0 ? x + width_ : x >= width_ ? x - width_ : x;
    p.x1 = p.x0 + 1 < width_ ? p.x0 + 1 : 0;
    p.y0 = std::clamp(y, 0, height_ - 1);
    p.y1 = std::clamp(y + 1, 0, height_ - 1);
    return p;
}

EnvironmentMap::Place EnvironmentMap::place(const Vec3& d, float& sine) const {
    const float x = dot(d, x_axis_), y = dot(d, y_axis_), z = dot(d, z_axis_);
    sine = std::sqrt(x * x + z * z);
    // The angle from the pole by both its sine and cosine: no digits are lost near the poles.
    return place(azimuth_turn(-z, x) * static_cast<float>(width_) - 0.5f,
                 2.0f * azimuth_turn(y, sine) * half_turn_ - margin_);
}

Rgb EnvironmentMap::radiance(const Vec3& direction) const {
    float sine;
    const Place p = place(direction, sine);
    const Rgb upper = clean_texel(p.x0, p.y0) * (1.0f - p.fx) + clean_texel(p.x1, p.y0) * p.fx;
    const Rgb lower = clean_texel(p.x0, p.y1) * (1.0f - p.fx) + clean_texel(p.x1, p.y1) * p.fx;
    return (upper * (1.0f - p.fy) + lower * p.fy) * scale_;
}

float EnvironmentMap::row_density(int y) const {
    const std::uint32_t* const begin = &rows_[static_cast<std::size_t>(y)];
    return static_cast<float>(begin[1] - begin[0]) * (on_pole(y) ? 2.0f : 1.0f);
}

float EnvironmentMap::column_share(int x, int y) const {
    const std::uint32_t* const begin =
        &columns_[static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1) + static_cast<std::size_t>(x)];
    return static_cast<float>(begin[1] - begin[0]);
}

int EnvironmentMap::pick_column(int y, std::uint32_t bits) const {
    const auto row = static_cast<std::size_t>(y);
    const std::size_t entries = std::size_t{1} << guide_bits_;
    const std::uint32_t* const guide = &guide_[row * (entries + 1)];
    const std::size_t entry = std::uint64_t{bits} >> (32 - guide_bits_);
    const std::size_t low = guide[entry];
    const std::uint32_t* const begin = &columns_[row * (static_cast<std::size_t>(width_) + 1)];
    return static_cast<int>(low + pick(begin + low, guide[entry + 1] - low + 1, bits));
}

float EnvironmentMap::pdf(const Place& p, float sine) const {
    const float upper = row_density(p.y0) * mix(column_share(p.x0, p.y0), column_share(p.x1, p.y0), p.fx);
    const float lower = row_density(p.y1) * mix(column_share(p.x0, p.y1), column_share(p.x1, p.y1), p.fx);
    // On the pole itself the density is as large as it likes.
    return mix(upper, lower, p.fy) * density_scale_ / std::max(sine, 1e-9f);
}

float EnvironmentMap::pdf(const Vec3& direction) const {
    if (black()) return 0.0f;
    float sine;
    const Place p = place(direction, sine);
    return pdf(p, sine);
}

EnvironmentMap::Sample EnvironmentMap::sample(const Draw& random) const {
    const auto row = static_cast<int>(pick(rows_.data(), rows_.size() - 1, random[1]));
    const float u = static_cast<float>(pick_column(row, random[2])) + sample_tent(random[3] & 0xffffu);
    const float rows = std::abs(static_cast<float>(row) + margin_ + sample_tent(random[3] >> 16));
    const float from_pole = std::min(rows, 2.0f * half_turn_ - rows);
    const float turn = (u + 0.5f) / static_cast<float>(width_);
    const SinCos polar = sincos_turn(0.5f * from_pole / half_turn_);
    const SinCos azimuth = sincos_turn(turn < 0.0f ? turn + 1.0f : turn);
    const Vec3 direction =
        x_axis_ * (polar.sin * azimuth.sin) + y_axis_ * polar.cos - z_axis_ * (polar.sin * azimuth.cos);
    return {direction * (1.0f / std::sqrt(dot(direction, direction))),
            pdf(place(u, from_pole - margin_), std::abs(polar.sin))};
}

}  // namespace treefarm
