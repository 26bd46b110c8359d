#include "worker/lights/environment_map.h"

#include <algorithm>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kTotal = std::uint32_t(1) << 31;

/// Shares of 2^31 in proportion to weights, at least 1 for each weight above 0: writes where each share begins.
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
    return total > 0;
}

/// Index of the share that owns these bits.
std::size_t pick(const std::uint32_t* begin, std::size_t count, std::uint32_t bits) {
    return static_cast<std::size_t>(std::upper_bound(begin, begin + count, bits >> 1) - begin) - 1;
}

/// Draws from [0, 1) with a density that runs linearly from a to b, not both 0.
float sample_linear(float u, float a, float b) {
    const float inverse = 1.0f / (a + b);
    a *= inverse;
    b *= inverse;
    return std::min(u / (a + std::sqrt(a * a * (1.0f - u) + b * b * u)), 0x1.fffffep-1f);
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
      sines_(static_cast<std::size_t>(height_)),
      rows_(static_cast<std::size_t>(height_) + 2),
      columns_((static_cast<std::size_t>(height_) + 1) * static_cast<std::size_t>(width_)) {
    const auto width = static_cast<std::size_t>(width_);
    float peak = 0;
    double sum = 0, sines = 0;
    for (int y = 0; y < height_; ++y) {
        // On a pole, where the sine is 0, a sixth of a row away: the share of the sphere that the texel shines from.
        const float from_pole =
            std::clamp(static_cast<float>(y) + margin_, 1.0f / 6.0f, half_turn_ - 1.0f / 6.0f) / half_turn_;
        const float sine = sincos_turn(0.5f * from_pole).sin;
        sines_[static_cast<std::size_t>(y)] = sine;
        sines += double(sine);
        for (int x = 0; x < width_; ++x) {
            const Rgb texel = clean_texel(x, y);
            peak = std::max(peak, luminance(texel));
            sum += double(sine) * double(average(texel));
        }
    }
    mean_ = double(scale_) * sum / (sines * static_cast<double>(width_));
    inverse_peak_ = peak > 0.0f ? 1.0f / peak : 0.0f;

    std::vector<double> row_weights(static_cast<std::size_t>(height_) + 1), weights(width);
    std::vector<float> upper(width), lower(width);
    const auto read_row = [&](int y, std::vector<float>& row) {
        for (int x = 0; x < width_; ++x)
            row[static_cast<std::size_t>(x)] = weight(x, y);
    };
    read_row(0, lower);
    for (int row = 0; row <= height_; ++row) {
        std::swap(upper, lower);
        read_row(std::min(row, height_ - 1), lower);
        if (row == 0) upper = lower;
        double total = 0;
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t next = x + 1 < width ? x + 1 : 0;
            weights[x] = 0.25 * (double(upper[x]) + double(upper[next]) + double(lower[x]) + double(lower[next]));
            total += weights[x];
        }
        row_weights[static_cast<std::size_t>(row)] = total * double(patch_height(row));
        share(weights, &columns_[static_cast<std::size_t>(row) * width]);
    }
    if (!share(row_weights, rows_.data())) mean_ = 0;
    rows_.back() = kTotal;
}

Rgb EnvironmentMap::clean_texel(int x, int y) const {
    Rgb c = texel(*image_, x, y);
    for (int i = 0; i < 3; ++i)
        if (!(c[i] > 0.0f && c[i] <= 1e30f)) c[i] = 0.0f;
    return c;
}

float EnvironmentMap::weight(int x, int y) const {
    return luminance(clean_texel(x, y)) * inverse_peak_ * sines_[static_cast<std::size_t>(y)];
}

EnvironmentMap::Place EnvironmentMap::place(const Vec3& d) const {
    const float x = dot(d, x_axis_), y = dot(d, y_axis_), z = dot(d, z_axis_);
    Place p;
    p.sine = std::sqrt(x * x + z * z);
    // The angle from the pole by both its sine and cosine: no digits are lost near the poles.
    const float u = azimuth_turn(-z, x) * static_cast<float>(width_) - 0.5f;
    const float v = 2.0f * azimuth_turn(y, p.sine) * half_turn_ - margin_;
    const float left = std::floor(u), top = std::floor(v);
    p.fx = u - left;
    p.x0 = static_cast<int>(left);
    if (p.x0 < 0) p.x0 += width_;
    if (p.x0 >= width_) p.x0 -= width_;
    p.x1 = p.x0 + 1 < width_ ? p.x0 + 1 : 0;
    const int outer = margin_ > 0.0f ? 0 : 1;
    p.row = std::clamp(static_cast<int>(top) + 1, outer, height_ - outer);
    p.fy = v - static_cast<float>(p.row - 1);
    p.y0 = std::max(p.row - 1, 0);
    p.y1 = std::min(p.row, height_ - 1);
    return p;
}

Rgb EnvironmentMap::radiance(const Vec3& direction) const {
    const Place p = place(direction);
    const Rgb upper = clean_texel(p.x0, p.y0) * (1.0f - p.fx) + clean_texel(p.x1, p.y0) * p.fx;
    const Rgb lower = clean_texel(p.x0, p.y1) * (1.0f - p.fx) + clean_texel(p.x1, p.y1) * p.fx;
    return (upper * (1.0f - p.fy) + lower * p.fy) * scale_;
}

std::uint32_t EnvironmentMap::column_begin(int row, int x) const {
    if (x == width_) return kTotal;
    return columns_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

float EnvironmentMap::pdf(const Vec3& direction) const {
    if (black()) return 0.0f;
    const Place p = place(direction);
    const auto row = static_cast<std::size_t>(p.row);
    const float row_share = static_cast<float>(rows_[row + 1] - rows_[row]);
    if (!(row_share > 0.0f)) return 0.0f;
    const float column_share = static_cast<float>(column_begin(p.row, p.x0 + 1) - column_begin(p.row, p.x0));
    const float a = weight(p.x0, p.y0), b = weight(p.x1, p.y0), c = weight(p.x0, p.y1), d = weight(p.x1, p.y1);
    const float mean = 0.25f * (a + b + c + d);
    if (!(mean > 0.0f)) return 0.0f;
    const float here = mix(mix(a, b, p.fx), mix(c, d, p.fx), p.fy);
    const float patches = static_cast<float>(width_) * half_turn_ / patch_height(p.row);
    // d(u) d(v) = d(solid angle) / (2 pi^2 sin(theta)); on the pole itself the density is as large as it likes.
    const float solid_angle = 2.0f * kPi * kPi * std::max(p.sine, 1e-9f);
    return (row_share * 0x1p-31f) * (column_share * 0x1p-31f) * (here / mean) * patches / solid_angle;
}

Vec3 EnvironmentMap::sample(const Draw& random) const {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t row = pick(rows_.data(), rows_.size() - 1, random[1]);
    const std::size_t column = pick(&columns_[row * width], width, random[2]);
    const int x0 = static_cast<int>(column), x1 = x0 + 1 < width_ ? x0 + 1 : 0;
    const int y0 = std::max(static_cast<int>(row) - 1, 0), y1 = std::min(static_cast<int>(row), height_ - 1);
    const float a = weight(x0, y0), b = weight(x1, y0), c = weight(x0, y1), d = weight(x1, y1);
    const auto unit16 = [](std::uint32_t bits) { return (static_cast<float>(bits) + 0.5f) * 0x1p-16f; };
    const float fy = sample_linear(unit16(random[3] >> 16), a + b, c + d);
    const float fx = sample_linear(unit16(random[3] & 0xffffu), mix(a, c, fy), mix(b, d, fy));
    float u = (static_cast<float>(x0) + 0.5f + fx) / static_cast<float>(width_);
    if (u >= 1.0f) u -= 1.0f;
    const float top = row == 0 ? 0.0f : static_cast<float>(row - 1) + margin_;
    const float v = std::min((top + fy * patch_height(static_cast<int>(row))) / half_turn_, 1.0f);
    const SinCos polar = sincos_turn(0.5f * v), azimuth = sincos_turn(u);
    return normalize(x_axis_ * (polar.sin * azimuth.sin) + y_axis_ * polar.cos - z_axis_ * (polar.sin * azimuth.cos));
}

}  // namespace treefarm
