#include "worker/lights/environment_map.h"

#include <algorithm>
#include <bit>

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

/// Index of the share that owns these bits, without a branch that nothing predicts.
std::size_t pick(const std::uint32_t* begin, std::size_t count, std::uint32_t bits) {
    const std::uint32_t* at = begin;
    for (; count > 1; count -= count / 2)
        at += at[count / 2] <= bits >> 1 ? count / 2 : 0;
    return static_cast<std::size_t>(at - begin);
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
      scale_(emitter.scale),
      x_axis_(emitter.x_axis),
      y_axis_(emitter.y_axis),
      z_axis_(emitter.z_axis),
      sines_(static_cast<std::size_t>(height_)),
      rows_(static_cast<std::size_t>(height_) + 2),
      columns_((static_cast<std::size_t>(height_) + 1) * static_cast<std::size_t>(width_)),
      guide_bits_(std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(width_))) - 5)),
      guide_((static_cast<std::size_t>(height_) + 1) * ((std::size_t{1} << guide_bits_) + 1)) {
    const auto width = static_cast<std::size_t>(width_);
    float peak = 0;
    double sum = 0, sines = 0;
    bool all_clean = true;
    for (int y = 0; y < height_; ++y) {
        const float sine = sincos_turn((static_cast<float>(y) + 0.5f) / (2.0f * static_cast<float>(height_))).sin;
        sines_[static_cast<std::size_t>(y)] = sine;
        sines += double(sine);
        for (int x = 0; x < width_; ++x) {
            const Rgb texel = clean_texel(x, y);
            all_clean = all_clean && texel == treefarm::texel(image, x, y);
            peak = std::max(peak, luminance(texel));
            sum += double(sine) * double(average(texel));
        }
    }
    clean_ = all_clean;
    mean_ = double(scale_) * sum / (sines * static_cast<double>(width_));
    inverse_peak_ = peak > 0.0f ? 1.0f / peak : 0.0f;

    std::vector<double> row_weights(static_cast<std::size_t>(height_) + 1), weights(width);
    std::vector<float> upper(width), lower(width);
    const auto read_row = [&](int y, std::vector<float>& row) {
        for (int x = 0; x < width_; ++x)
            row[static_cast<std::size_t>(x)] = weight(clean_texel(x, y), y);
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
        std::uint32_t* const begin = &columns_[static_cast<std::size_t>(row) * width];
        share(weights, begin);
        const std::size_t entries = std::size_t{1} << guide_bits_;
        std::uint32_t* const guide = &guide_[static_cast<std::size_t>(row) * (entries + 1)];
        for (std::size_t k = 0; k < entries; ++k)
            guide[k] =
                static_cast<std::uint32_t>(pick(begin, width, static_cast<std::uint32_t>(k << (32 - guide_bits_))));
        guide[entries] = static_cast<std::uint32_t>(width - 1);
    }
    if (!share(row_weights, rows_.data())) mean_ = 0;
    rows_.back() = kTotal;
}

Rgb EnvironmentMap::clean_texel(int x, int y) const {
    Rgb c = texel(*image_, x, y);
    if (clean_) return c;
    for (int i = 0; i < 3; ++i)
        if (!(c[i] > 0.0f && c[i] <= 1e30f)) c[i] = 0.0f;
    return c;
}

float EnvironmentMap::weight(const Rgb& texel, int y) const {
    return luminance(texel) * inverse_peak_ * sines_[static_cast<std::size_t>(y)];
}

EnvironmentMap::Place EnvironmentMap::place(const Vec3& d) const {
    const float x = dot(d, x_axis_), y = dot(d, y_axis_), z = dot(d, z_axis_);
    Place p;
    p.sine = std::sqrt(x * x + z * z);
    // The angle from the pole by both its sine and cosine: no digits are lost near the poles.
    const float u = azimuth_turn(-z, x) * static_cast<float>(width_) - 0.5f;
    const float v = 2.0f * azimuth_turn(y, p.sine) * static_cast<float>(height_) - 0.5f;
    const float left = std::floor(u), top = std::floor(v);
    p.fx = u - left;
    p.fy = v - top;
    p.x0 = static_cast<int>(left);
    if (p.x0 < 0) p.x0 += width_;
    if (p.x0 >= width_) p.x0 -= width_;
    p.x1 = p.x0 + 1 < width_ ? p.x0 + 1 : 0;
    p.row = std::clamp(static_cast<int>(top) + 1, 0, height_);
    p.y0 = std::max(p.row - 1, 0);
    p.y1 = std::min(p.row, height_ - 1);
    return p;
}

EnvironmentMap::Corners EnvironmentMap::corners(const Place& p) const {
    const int x[] = {p.x0, p.x1, p.x0, p.x1}, y[] = {p.y0, p.y0, p.y1, p.y1};
    Corners corners;
    for (int i = 0; i < 4; ++i) {
        corners.color[i] = clean_texel(x[i], y[i]);
        corners.weight[i] = weight(corners.color[i], y[i]);
    }
    return corners;
}

std::uint32_t EnvironmentMap::column_begin(int row, int x) const {
    if (x == width_) return kTotal;
    return columns_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

std::size_t EnvironmentMap::pick_column(std::size_t row, std::uint32_t bits) const {
    const std::uint32_t* const guide = &guide_[row * ((std::size_t{1} << guide_bits_) + 1)];
    const std::size_t entry = guide_bits_ == 0 ? 0 : bits >> (32 - guide_bits_);
    const std::size_t low = guide[entry];
    const std::uint32_t* const begin = &columns_[row * static_cast<std::size_t>(width_)];
    return low + pick(begin + low, guide[entry + 1] - low + 1, bits);
}

EnvironmentLight EnvironmentMap::light(const Place& p, const Corners& c) const {
    const Rgb upper = c.color[0] * (1.0f - p.fx) + c.color[1] * p.fx;
    const Rgb lower = c.color[2] * (1.0f - p.fx) + c.color[3] * p.fx;
    EnvironmentLight light;
    light.radiance = (upper * (1.0f - p.fy) + lower * p.fy) * scale_;
    if (black()) return light;
    const auto row = static_cast<std::size_t>(p.row);
    const float row_share = static_cast<float>(rows_[row + 1] - rows_[row]);
    const float column_share = static_cast<float>(column_begin(p.row, p.x0 + 1) - column_begin(p.row, p.x0));
    const float mean = 0.25f * (c.weight[0] + c.weight[1] + c.weight[2] + c.weight[3]);
    if (!(row_share > 0.0f) || !(mean > 0.0f)) return light;
    const float here = mix(mix(c.weight[0], c.weight[1], p.fx), mix(c.weight[2], c.weight[3], p.fx), p.fy);
    const float patches = static_cast<float>(width_) * static_cast<float>(height_) / patch_height(p.row);
    // d(u) d(v) = d(solid angle) / (2 pi^2 sin(theta)); on the pole itself the density is as large as it likes.
    const float solid_angle = 2.0f * kPi * kPi * std::max(p.sine, 1e-9f);
    light.pdf = (row_share * 0x1p-31f) * (column_share * 0x1p-31f) * (here / mean) * patches / solid_angle;
    return light;
}

EnvironmentLight EnvironmentMap::look(const Vec3& direction) const {
    const Place p = place(direction);
    return light(p, corners(p));
}

EnvironmentMap::Sample EnvironmentMap::sample(const Draw& random) const {
    Place p;
    const std::size_t row = pick(rows_.data(), rows_.size() - 1, random[1]);
    p.row = static_cast<int>(row);
    p.x0 = static_cast<int>(pick_column(row, random[2]));
    p.x1 = p.x0 + 1 < width_ ? p.x0 + 1 : 0;
    p.y0 = std::max(p.row - 1, 0);
    p.y1 = std::min(p.row, height_ - 1);
    const Corners c = corners(p);
    const auto unit16 = [](std::uint32_t bits) { return (static_cast<float>(bits) + 0.5f) * 0x1p-16f; };
    p.fy = sample_linear(unit16(random[3] >> 16), c.weight[0] + c.weight[1], c.weight[2] + c.weight[3]);
    p.fx = sample_linear(unit16(random[3] & 0xffffu), mix(c.weight[0], c.weight[2], p.fy),
                         mix(c.weight[1], c.weight[3], p.fy));
    float u = (static_cast<float>(p.x0) + 0.5f + p.fx) / static_cast<float>(width_);
    if (u >= 1.0f) u -= 1.0f;
    // In the outer rows, half as high, the texels above and below are one.
    const float top = row == 0 ? 0.0f : static_cast<float>(p.row) - 0.5f;
    const float v = std::min((top + p.fy * patch_height(p.row)) / static_cast<float>(height_), 1.0f);
    const SinCos polar = sincos_turn(0.5f * v), azimuth = sincos_turn(u);
    p.sine = polar.sin;
    return {normalize(x_axis_ * (polar.sin * azimuth.sin) + y_axis_ * polar.cos - z_axis_ * (polar.sin * azimuth.cos)),
            light(p, c)};
}

}  // namespace treefarm
