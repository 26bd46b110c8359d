// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/environment_map.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "common/base/prefetch.h"
#include "common/math/elementary.h"
#include "common/math/warp_batch.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kTotal = std::uint32_t(1) << 31;

/// Divides 2^31 in proportion to weights, at least 1 for each weight above 0: writes where each interval begins, and
/// the end. Returns false if all weights are 0.
bool apportion(const std::vector<double>& weights, std::uint32_t* begin) {
    double total = 0;
    std::uint32_t positive = 0;
    for (const double w : weights) {
        total += w;
        positive += w > 0;
    }
    const auto spare = double(kTotal - positive);
    double sum = 0;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        begin[i] = total > 0 ? before + static_cast<std::uint32_t>(std::min(sum / total, 1.0) * spare) : 0;
        sum += weights[i];
        before += weights[i] > 0;
        // The rounding remainder goes to the last entry that has a weight.
        if (before == positive) {
            std::fill(begin + i + 1, begin + weights.size(), kTotal);
            break;
        }
    }
    begin[weights.size()] = kTotal;
    return total > 0;
}

/// Index of the interval that contains `bits`, without an unpredictable branch.
std::size_t pick(const std::uint32_t* begin, std::size_t count, std::uint32_t bits) {
    const std::uint32_t* at = begin;
    for (; count > 1; count -= count / 2)
        at += at[count / 2] <= bits >> 1 ? count / 2 : 0;
    return static_cast<std::size_t>(at - begin);
}

/// Writes to 2^lookup_bits + 1 entries the intervals that contain the whole multiples of 2^(32 - lookup_bits).
void fill_lookup(const std::uint32_t* begin, std::size_t count, int lookup_bits, std::uint32_t* lookup) {
    const std::size_t entries = std::size_t{1} << lookup_bits;
    for (std::size_t k = 0; k < entries; ++k)
        lookup[k] = static_cast<std::uint32_t>(pick(begin, count, static_cast<std::uint32_t>((k << 32) / entries)));
    lookup[entries] = static_cast<std::uint32_t>(count - 1);
}

/// Look-up entry from which the search for `bits` starts; it ends at the next entry.
const std::uint32_t* look_up(const std::uint32_t* lookup, int lookup_bits, std::uint32_t bits) {
    return lookup + (std::uint64_t{bits} >> (32 - lookup_bits));
}

/// pick() between the intervals of two look-up entries.
int pick_between(const std::uint32_t* begin, std::uint32_t low, std::uint32_t high, std::uint32_t bits) {
    return static_cast<int>(low + pick(begin + low, high - low + 1, bits));
}

/// Draws from [-1, 1] with density 1 - |x|.
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
      frame_{image.width,   image.height,   emitter.rows_at_poles && image.height > 1 ? 0.0f : 0.5f,
             0.0f,          emitter.x_axis, emitter.y_axis,
             emitter.z_axis},
      scale_(emitter.scale),
      columns_(static_cast<std::size_t>(image.height) * (static_cast<std::size_t>(image.width) + 1)),
      lookup_bits_(std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(image.width))) - 2)),
      lookup_(static_cast<std::size_t>(image.height) * ((std::size_t{1} << lookup_bits_) + 1)) {
    frame_.half_turn = static_cast<float>(frame_.height - 1) + 2.0f * frame_.margin;
    // d(u) d(v) = d(solid angle) / (2 pi^2 sin(theta)).
    density_scale_ =
        static_cast<float>(double(frame_.width) * double(frame_.half_turn) / (2 * double(kPi) * double(kPi)));
    const auto width = static_cast<std::size_t>(frame_.width);
    double sum = 0, sines = 0;
    bool all_clean = true;
    std::vector<double> row_weights(static_cast<std::size_t>(frame_.height)), weights(width);
    EnvironmentGrid grid(frame_.width, frame_.height);
    for (int y = 0; y < frame_.height; ++y) {
        const auto row = static_cast<std::size_t>(y);
        // On a pole the sine is 0: a sixth of a row away instead, which gives the texel's solid angle.
        const float row_from_pole = static_cast<float>(y) + frame_.margin;
        const float from_pole = std::clamp(row_from_pole, 1.0f / 6.0f, frame_.half_turn - 1.0f / 6.0f);
        const auto sine = double(sincos_turn(0.5f * (from_pole / frame_.half_turn)).sin);
        sines += sine;
        for (int x = 0; x < frame_.width; ++x) {
            const Rgb texel = clean_texel(x, y);
            all_clean = all_clean && texel == treefarm::texel(image, x, y);
            sum += sine * double(average(texel));
            row_weights[row] += weights[static_cast<std::size_t>(x)] = sine * double(luminance(texel));
            grid.add(x, y, weights[static_cast<std::size_t>(x)], sine);
        }
        if (on_pole(y)) row_weights[row] *= 0.5;
        std::uint32_t* const begin = &columns_[row * (width + 1)];
        apportion(weights, begin);
        fill_lookup(begin, width, lookup_bits_, &lookup_[row * ((std::size_t{1} << lookup_bits_) + 1)]);
    }
    clean_ = all_clean;
    mean_ = double(scale_) * sum / (sines * static_cast<double>(frame_.width));
    const double whole = std::accumulate(row_weights.begin(), row_weights.end(), 0.0);
    if (!(whole > 0)) mean_ = 0;
    mean_luminance_ = mean_ > 0 ? double(scale_) * whole / (sines * static_cast<double>(frame_.width)) : 0.0;
    for (const EnvironmentPart& part : grid.parts(kMostParts))
        add_part(part, whole, row_weights);
}

void EnvironmentMap::add_part(const EnvironmentPart& texels, double whole, const std::vector<double>& row_weights) {
    const auto rows = static_cast<std::size_t>(texels.y1 - texels.y0);
    Part part{texels, 0, std::vector<std::uint32_t>(rows + 1), std::vector<std::uint32_t>((1u << kRowLookupBits) + 1),
              std::vector<Part::Row>(rows)};
    std::vector<double> weights(rows);
    double sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const int y = texels.y0 + static_cast<int>(row);
        part.rows[row] = {column_begin(texels.x0, y), column_begin(texels.x1, y), 0.0f};
        const double columns = double(part.rows[row].end - part.rows[row].begin) / double(kTotal);
        sum += weights[row] = row_weights[static_cast<std::size_t>(y)] * columns;
    }
    apportion(weights, part.row_begin.data());
    fill_lookup(part.row_begin.data(), rows, kRowLookupBits, part.row_lookup.data());
    for (std::size_t row = 0; row < rows; ++row) {
        if (!(weights[row] > 0)) continue;
        const int y = texels.y0 + static_cast<int>(row);
        const auto columns = double(part.rows[row].end - part.rows[row].begin);
        const double probability = double(part.row_begin[row + 1] - part.row_begin[row]) / double(kTotal);
        part.rows[row].density = static_cast<float>(probability / columns * (on_pole(y) ? 2.0 : 1.0));
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

inline EnvironmentMap::Footprint EnvironmentMap::Frame::footprint(float u, float v) const {
    const float left = std::floor(u), top = std::floor(v);
    const int x = static_cast<int>(left), y = static_cast<int>(top);
    Footprint p;
    p.fx = u - left;
    p.fy = v - top;
    p.x0 = x < 0 ? x + width : x >= width ? x - width : x;
    p.x1 = p.x0 + 1 < width ? p.x0 + 1 : 0;
    p.y0 = std::clamp(y, 0, height - 1);
    p.y1 = std::clamp(y + 1, 0, height - 1);
    return p;
}

inline EnvironmentMap::Sample EnvironmentMap::Frame::locate(int x, int y, std::uint32_t tent_bits) const {
    const float u = static_cast<float>(x) + sample_tent(tent_bits & 0xffffu);
    const float rows = std::abs(static_cast<float>(y) + margin + sample_tent(tent_bits >> 16));
    const float from_pole = std::min(rows, 2.0f * half_turn - rows);
    const float turn = (u + 0.5f) / static_cast<float>(width);
    const SinCos polar = sincos_turn(0.5f * from_pole / half_turn);
    const SinCos azimuth = sincos_turn(select(turn < 0.0f, turn + 1.0f, turn));
    const Vec3 direction = x_axis * (polar.sin * azimuth.sin) + y_axis * polar.cos - z_axis * (polar.sin * azimuth.cos);
    return {direction * (1.0f / std::sqrt(dot(direction, direction))), footprint(u, from_pole - margin),
            std::abs(polar.sin)};
}

inline Vec3 EnvironmentMap::Frame::direction(float u, float from_pole) const {
    const float turn = (u + 0.5f) / static_cast<float>(width);
    const SinCos polar = sincos_turn(0.5f * from_pole / half_turn);
    const SinCos azimuth = sincos_turn(turn - std::floor(turn));
    return normalize(x_axis * (polar.sin * azimuth.sin) + y_axis * polar.cos - z_axis * (polar.sin * azimuth.cos));
}

DirectionCone EnvironmentMap::part_cone(int part) const {
    // A tent reaches one texel beyond the centres of the part's outer texels. Lines closer than the margin between.
    const EnvironmentPart& texels = parts_[static_cast<std::size_t>(part)].texels;
    const auto width = static_cast<float>(texels.x1 - texels.x0 + 1),
               height = static_cast<float>(texels.y1 - texels.y0 + 1);
    constexpr int kLines = 32;
    const auto at = [&](int i, int k) {
        const float u = static_cast<float>(texels.x0 - 1) + width * static_cast<float>(i) / kLines;
        const float row = static_cast<float>(texels.y0 - 1) + height * static_cast<float>(k) / kLines + frame_.margin;
        return frame_.direction(u, std::clamp(row, 0.0f, frame_.half_turn));
    };
    Imath::V3d sum(0.0);
    for (int i = 0; i <= kLines; ++i)
        for (int k = 0; k <= kLines; ++k)
            sum += Imath::V3d(at(i, k));
    if (!(sum.dot(sum) > 1e-6)) return DirectionCone::all();
    DirectionCone cone{normalize(Vec3(sum)), 0.0f};
    for (int i = 0; i <= kLines; ++i)
        for (int k = 0; k <= kLines; ++k)
            cone.half_turns = std::max(cone.half_turns, half_turns_between(cone.axis, at(i, k)));
    const float step = std::max(2.0f * width / static_cast<float>(frame_.width), height / frame_.half_turn) / kLines;
    cone.half_turns = std::min(cone.half_turns + step, 1.0f);
    return cone;
}

EnvironmentMap::Footprint EnvironmentMap::footprint(const Vec3& d, float& sine) const {
    const float x = dot(d, frame_.x_axis), y = dot(d, frame_.y_axis), z = dot(d, frame_.z_axis);
    sine = std::sqrt(x * x + z * z);
    // Angle from the pole by both its sine and cosine: no digits are lost near the poles.
    return frame_.footprint(azimuth_turn(-z, x) * static_cast<float>(frame_.width) - 0.5f,
                            2.0f * azimuth_turn(y, sine) * frame_.half_turn - frame_.margin);
}

Rgb EnvironmentMap::radiance(const Vec3& direction) const {
    float sine;
    return radiance(footprint(direction, sine));
}

Rgb EnvironmentMap::radiance(const Footprint& p) const {
    const Rgb upper = clean_texel(p.x0, p.y0) * (1.0f - p.fx) + clean_texel(p.x1, p.y0) * p.fx;
    const Rgb lower = clean_texel(p.x0, p.y1) * (1.0f - p.fx) + clean_texel(p.x1, p.y1) * p.fx;
    return (upper * (1.0f - p.fy) + lower * p.fy) * scale_;
}

void EnvironmentMap::prefetch(const Footprint& p) const {
    prefetch_texel(*image_, p.x0, p.y0);
    prefetch_texel(*image_, p.x0, p.y1);
    prefetch_line(columns(p.y0) + p.x0);
    prefetch_line(columns(p.y1) + p.x0);
}

int EnvironmentMap::part_of(int x, int y) const {
    const auto part = [&](int i) -> const EnvironmentPart& { return parts_[static_cast<std::size_t>(i)].texels; };
    return treefarm::part_of(x, y, part_count(), part);
}

float EnvironmentMap::density(int part, int x, int y) const {
    const Part& of = parts_[static_cast<std::size_t>(part)];
    const std::uint32_t* const begin = columns(y) + x;
    return of.rows[static_cast<std::size_t>(y - of.texels.y0)].density * static_cast<float>(begin[1] - begin[0]);
}

float EnvironmentMap::pdf(const Footprint& p, float sine, const PartChoice& choice) const {
    // Nearly always all four texels are of one part.
    const int first = part_of(p.x0, p.y0);
    const bool one_part = parts_[static_cast<std::size_t>(first)].texels.holds(p.x1, p.y1);
    const auto texel = [&](int x, int y) {
        const int part = one_part ? first : part_of(x, y);
        return choice[static_cast<std::size_t>(part)] * density(part, x, y);
    };
    const float upper = mix(texel(p.x0, p.y0), texel(p.x1, p.y0), p.fx);
    const float lower = mix(texel(p.x0, p.y1), texel(p.x1, p.y1), p.fx);
    // At the pole itself the density has no bound.
    return mix(upper, lower, p.fy) * density_scale_ / std::max(sine, 1e-9f);
}

float EnvironmentMap::pdf(const Vec3& direction, const PartChoice& choice) const {
    if (black()) return 0.0f;
    float sine;
    const Footprint p = footprint(direction, sine);
    return pdf(p, sine, choice);
}

int EnvironmentMap::pick_row(const Part& part, std::uint32_t bits) const {
    const std::uint32_t* const between = look_up(part.row_lookup.data(), kRowLookupBits, bits);
    return part.texels.y0 + pick_between(part.row_begin.data(), between[0], between[1], bits);
}

std::uint32_t EnvironmentMap::bits_in_part(const Part& part, int y, std::uint32_t bits) const {
    const Part::Row& row = part.rows[static_cast<std::size_t>(y - part.texels.y0)];
    const std::uint64_t width = 2 * std::uint64_t{row.end - row.begin};
    return static_cast<std::uint32_t>(2 * std::uint64_t{row.begin} + (std::uint64_t{bits} * width >> 32));
}

const std::uint32_t* EnvironmentMap::lookup(int y, std::uint32_t bits) const {
    const std::size_t entries = (std::size_t{1} << lookup_bits_) + 1;
    return look_up(&lookup_[static_cast<std::size_t>(y) * entries], lookup_bits_, bits);
}

EnvironmentMap::Sample EnvironmentMap::sample(int chosen, const Draw& random) const {
    const Part& part = parts_[static_cast<std::size_t>(chosen)];
    const int y = pick_row(part, random[1]);
    const std::uint32_t bits = bits_in_part(part, y, random[2]);
    const std::uint32_t* const between = lookup(y, bits);
    return frame_.locate(pick_between(columns(y), between[0], between[1], bits), y, random[3]);
}

void EnvironmentMap::sample(EnvironmentBatch& b) const {
    for (std::uint32_t i = 0; i < b.count_; ++i) {
        const Part& part = parts_[static_cast<std::size_t>(b.part_[i])];
        b.row_[i] = pick_row(part, b.row_bits_[i]);
        b.column_bits_[i] = bits_in_part(part, b.row_[i], b.column_bits_[i]);
        prefetch_line(lookup(b.row_[i], b.column_bits_[i]));
    }
    for (std::uint32_t i = 0; i < b.count_; ++i) {
        const std::uint32_t* const between = lookup(b.row_[i], b.column_bits_[i]);
        b.low_[i] = between[0];
        b.high_[i] = between[1];
        prefetch_line(columns(b.row_[i]) + (between[0] + between[1]) / 2);
    }
    for (std::uint32_t i = 0; i < b.count_; ++i)
        b.column_[i] = pick_between(columns(b.row_[i]), b.low_[i], b.high_[i], b.column_bits_[i]);
    const Frame frame = frame_;  // a copy: stores below cannot alias it
    for (std::uint32_t i = 0; i < whole_lanes(b.count_); ++i) {
        const Sample s = frame.locate(b.column_[i], b.row_[i], b.tent_bits_[i]);
        b.dx_[i] = s.direction.x;
        b.dy_[i] = s.direction.y;
        b.dz_[i] = s.direction.z;
        b.x0_[i] = s.footprint.x0;
        b.x1_[i] = s.footprint.x1;
        b.y0_[i] = s.footprint.y0;
        b.y1_[i] = s.footprint.y1;
        b.fx_[i] = s.footprint.fx;
        b.fy_[i] = s.footprint.fy;
        b.sine_[i] = s.sine;
    }
}

}  // namespace treefarm
