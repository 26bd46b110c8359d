#include "worker/lights/environment_map.h"

#include <algorithm>
#include <bit>
#include <numeric>

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
      density_scale_(static_cast<float>(double(width_) * double(half_turn_) / (2 * double(kPi) * double(kPi)))),
      columns_(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1)),
      guide_bits_(std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(width_))) - 5)),
      guide_(static_cast<std::size_t>(height_) * ((std::size_t{1} << guide_bits_) + 1)) {
    const auto width = static_cast<std::size_t>(width_);
    double sum = 0, sines = 0;
    bool all_clean = true;
    std::vector<double> row_weights(static_cast<std::size_t>(height_)), weights(width);
    EnvironmentGrid grid(width_, height_);
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
            grid.add(x, y, weights[static_cast<std::size_t>(x)], sine);
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
    const double whole = std::accumulate(row_weights.begin(), row_weights.end(), 0.0);
    if (!(whole > 0)) mean_ = 0;
    for (const EnvironmentPart& part : grid.parts(kMostParts))
        add_part(part, whole, row_weights);
}

void EnvironmentMap::add_part(const EnvironmentPart& texels, double whole, const std::vector<double>& row_weights) {
    const auto rows = static_cast<std::size_t>(texels.y1 - texels.y0);
    Part part{texels, 0, std::vector<std::uint32_t>(rows + 1), std::vector<float>(rows)};
    std::vector<double> weights(rows);
    double sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const int y = texels.y0 + static_cast<int>(row);
        const double columns = double(column_begin(texels.x1, y) - column_begin(texels.x0, y)) / double(kTotal);
        sum += weights[row] = row_weights[static_cast<std::size_t>(y)] * columns;
    }
    share(weights, part.rows.data());
    for (std::size_t row = 0; row < rows; ++row) {
        if (!(weights[row] > 0)) continue;
        const int y = texels.y0 + static_cast<int>(row);
        const double columns = double(column_begin(texels.x1, y) - column_begin(texels.x0, y));
        part.density[row] = static_cast<float>(double(part.rows[row + 1] - part.rows[row]) / double(kTotal) / columns *
                                               (on_pole(y) ? 2.0 : 1.0));
    }
    part.weight = whole > 0 ? sum / whole : 0.0;
    parts_.push_back(std::move(part));
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

int EnvironmentMap::part_of(int x, int y) const {
    const auto part = [&](int i) -> const EnvironmentPart& { return parts_[static_cast<std::size_t>(i)].texels; };
    return treefarm::part_of(x, y, part_count(), part);
}

std::uint32_t EnvironmentMap::column_begin(int x, int y) const {
    return columns_[static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1) + static_cast<std::size_t>(x)];
}

float EnvironmentMap::density(int part, int x, int y) const {
    const Part& of = parts_[static_cast<std::size_t>(part)];
    const auto columns = static_cast<float>(column_begin(x + 1, y) - column_begin(x, y));
    return of.density[static_cast<std::size_t>(y - of.texels.y0)] * columns;
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

float EnvironmentMap::pdf(const Place& p, float sine, const PartChoice& choice) const {
    // Nearly always all four texels are of one part.
    const int first = part_of(p.x0, p.y0);
    const bool one_part = parts_[static_cast<std::size_t>(first)].texels.holds(p.x1, p.y1);
    const auto texel = [&](int x, int y) {
        const int part = one_part ? first : part_of(x, y);
        return choice[static_cast<std::size_t>(part)] * density(part, x, y);
    };
    const float upper = mix(texel(p.x0, p.y0), texel(p.x1, p.y0), p.fx);
    const float lower = mix(texel(p.x0, p.y1), texel(p.x1, p.y1), p.fx);
    // On the pole itself the density is as large as it likes.
    return mix(upper, lower, p.fy) * density_scale_ / std::max(sine, 1e-9f);
}

float EnvironmentMap::pdf(const Vec3& direction, const PartChoice& choice) const {
    if (black()) return 0.0f;
    float sine;
    const Place p = place(direction, sine);
    return pdf(p, sine, choice);
}

EnvironmentMap::Sample EnvironmentMap::sample(int chosen, const Draw& random) const {
    const Part& part = parts_[static_cast<std::size_t>(chosen)];
    const int row = part.texels.y0 + static_cast<int>(pick(part.rows.data(), part.rows.size() - 1, random[1]));
    // Bits within the part's share of the row.
    const std::uint32_t begin = column_begin(part.texels.x0, row), end = column_begin(part.texels.x1, row);
    const auto bits = static_cast<std::uint32_t>(2 * std::uint64_t{begin} +
                                                 (std::uint64_t{random[2]} * (2 * std::uint64_t{end - begin}) >> 32));
    const float u = static_cast<float>(pick_column(row, bits)) + sample_tent(random[3] & 0xffffu);
    const float rows = std::abs(static_cast<float>(row) + margin_ + sample_tent(random[3] >> 16));
    const float from_pole = std::min(rows, 2.0f * half_turn_ - rows);
    const float turn = (u + 0.5f) / static_cast<float>(width_);
    const SinCos polar = sincos_turn(0.5f * from_pole / half_turn_);
    const SinCos azimuth = sincos_turn(turn < 0.0f ? turn + 1.0f : turn);
    const Vec3 direction =
        x_axis_ * (polar.sin * azimuth.sin) + y_axis_ * polar.cos - z_axis_ * (polar.sin * azimuth.cos);
    return {direction * (1.0f / std::sqrt(dot(direction, direction))), place(u, from_pole - margin_),
            std::abs(polar.sin)};
}

}  // namespace treefarm
