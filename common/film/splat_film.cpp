// SPDX-License-Identifier: Apache-2.0
#include "common/film/splat_film.h"

#include <algorithm>
#include <cmath>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

/// Least number of entries of a log that are summed at once.
constexpr std::size_t kLogEntries = std::size_t{1} << 16;
/// Greatest splat, in quanta; its square is then at most 2^60 units.
constexpr double kMostQuanta = 0x1p40;
/// Squared quanta per unit of squares: the mean splat's square is one to four units.
constexpr double kPerSquare = 1.0 / (std::uint64_t{1} << kSquareBits);
/// Greatest number of splats in a part of a pass.
constexpr std::uint64_t kMostCount = std::uint64_t{1} << 48;

/// Stochastic rounding of a sum of quanta; the expectation is exact.
std::uint64_t rounded(double quanta, std::uint32_t bits) {
    const double whole = std::floor(quanta);
    const double threshold = static_cast<double>(bits) * 0x1p-32;
    return static_cast<std::uint64_t>(whole) + (threshold < quanta - whole ? 1u : 0u);
}

/// Square of a sum of quanta, in units of squares.
std::uint64_t square_of_sum(std::uint64_t quanta) {
    constexpr int kHalfBits = kSquareBits / 2;
    const std::uint64_t root = (std::min(quanta, kMostSplatSum) + (1u << (kHalfBits - 1))) >> kHalfBits;
    return root >> 31 ? kMostSplatSum : root * root;
}

bool is_splat(const Rgb& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z) && value.x >= 0 && value.y >= 0 &&
           value.z >= 0;
}

void add_splats(std::uint64_t& sum, std::uint64_t more) {
    sum = std::min(sum + more, kMostSplatSum);  // both are at most 2^63; larger sums are the limit
    if (more == kMostSplatSum) sum = kMostSplatSum;
}

void write_half(ByteWriter& out, std::span<const SplatMoments> moments, std::size_t half) {
    std::uint64_t count = 0;
    for (std::size_t slot = half; slot < moments.size(); slot += 2)
        count += moments[slot].empty() ? 0 : 1;
    out.put_varint(count);
    std::size_t next = half;
    for (std::size_t slot = half; slot < moments.size(); slot += 2) {
        if (moments[slot].empty()) continue;
        out.put_varint((slot - next) / 2);
        for (const auto& values : {moments[slot].sum, moments[slot].square})
            for (const std::uint64_t value : values)
                out.put_varint(value);
        next = slot + 2;
    }
}

/// Calls visit(pixel, moments) for each entry.
template <class Visit>
void read_half(ByteReader& in, std::uint64_t pixels, const Visit& visit) {
    const std::size_t count = in.get_count(7);
    std::uint64_t pixel = 0;
    for (std::size_t i = 0; i < count; ++i, ++pixel) {
        const std::uint64_t skip = in.get_varint();
        if (pixel >= pixels || skip >= pixels - pixel) throw FormatError("a splat beyond the film");
        pixel += skip;
        SplatMoments moments;
        for (auto* values : {&moments.sum, &moments.square})
            for (std::uint64_t& value : *values)
                if ((value = in.get_varint()) > kMostSplatSum) throw FormatError("a sum of splats above its limit");
        if (moments.empty()) throw FormatError("a pixel of splats that holds none");
        visit(pixel, moments);
    }
}

template <class Visit>
SplatCaps read_sums(std::span<const std::uint8_t> encoded, const SplatShape& shape, const Visit& visit) {
    ByteReader in(encoded);
    const std::uint64_t pixels = in.get_varint();
    const auto exponent = in.get<std::int16_t>();
    if (pixels != shape.pixels || exponent != shape.exponent)
        throw FormatError("splats of another film or in another quantum than the pass's");
    SplatCaps caps{in.get_varint(), in.get_varint()};
    if (caps.capped > kMostCount || caps.rejected > kMostCount) throw FormatError("counts of splats that cannot be");
    for (std::size_t half = 0; half < 2; ++half)
        read_half(in, pixels,
                  [&](std::uint64_t pixel, const SplatMoments& moments) { visit(2 * pixel + half, moments); });
    in.expect_end();
    return caps;
}

}  // namespace

std::int16_t splat_exponent(double mean) {
    const int exponent = mean > 0 && std::isfinite(mean) ? std::ilogb(mean) - 10 : 0;
    return static_cast<std::int16_t>(std::clamp(exponent, -kMostSplatExponent, kMostSplatExponent));
}

void SplatCaps::add(const SplatCaps& other) {
    capped += other.capped;
    rejected += other.rejected;
}

void SplatMoments::add(const SplatMoments& other) {
    for (std::size_t c = 0; c < 3; ++c) {
        add_splats(sum[c], other.sum[c]);
        add_splats(square[c], other.square[c]);
    }
}

bool SplatMoments::empty() const {
    return *this == SplatMoments{};
}

void SplatLog::SummedEntries::clear() {
    entries.clear();
    summed = 0;
    summing_size = kLogEntries;
}

void SplatLog::SummedEntries::push(const Entry& entry) {
    entries.push_back(entry);
    if (entries.size() >= summing_size) sum_up();
}

void SplatLog::SummedEntries::sum_up() {
    if (summed == entries.size()) return;
    const auto by_slot = [](const Entry& a, const Entry& b) { return a.slot < b.slot; };
    const auto fresh = entries.begin() + static_cast<std::ptrdiff_t>(summed);
    std::sort(fresh, entries.end(), by_slot);
    std::inplace_merge(entries.begin(), fresh, entries.end(), by_slot);
    std::size_t last = 0;
    for (std::size_t i = 1; i < entries.size(); ++i) {
        if (entries[i].slot == entries[last].slot)
            entries[last].moments.add(entries[i].moments);
        else
            entries[++last] = entries[i];
    }
    entries.resize(last + 1);
    summed = entries.size();
    summing_size = std::max(kLogEntries, 2 * summed);  // so that a unit with many pixels is not summed again and again
}

void SplatLog::begin(const SplatShape& shape) {
    shape_ = shape;
    per_value_ = exact_power_of_two(-shape.exponent);
    all_.clear();
    chain_.clear();
    caps_ = {};
}

void SplatLog::add(std::uint32_t pixel, std::uint32_t sample, const Rgb& value, const Draw& bits) {
    if (!is_splat(value)) {
        ++caps_.rejected;
        return;
    }
    Entry entry{2 * std::uint64_t{pixel} + (sample & 1), {}};
    bool capped = false;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        const double whole = static_cast<double>(value[c]) * per_value_, quanta = std::min(whole, kMostQuanta);
        capped = capped || whole > kMostQuanta;
        entry.moments.sum[k] = rounded(quanta, bits[k]);
        if (shape_.chains) continue;
        // Another random number than for the sum: a square that depended on its rounding would be no second moment.
        const std::uint32_t other = scrambled(bits[3], static_cast<std::uint32_t>(c) + 1);
        entry.moments.square[k] = rounded(quanta * quanta * kPerSquare, other);
    }
    caps_.capped += capped ? 1 : 0;
    if (!entry.moments.empty()) (shape_.chains ? chain_ : all_).push(entry);
}

void SplatLog::end_chain() {
    chain_.sum_up();
    for (Entry& entry : chain_.entries) {
        for (std::size_t c = 0; c < 3; ++c)
            entry.moments.square[c] = square_of_sum(entry.moments.sum[c]);
        all_.push(entry);
    }
    chain_.clear();
}

std::span<const SplatLog::Entry> SplatLog::summed() {
    end_chain();
    all_.sum_up();
    return all_.entries;
}

SplatSums::SplatSums(const SplatShape& shape) : shape_(shape), moments_(2 * std::size_t{shape.pixels}) {}

std::uint64_t SplatSums::saturated() const {
    std::uint64_t count = 0;
    for (const SplatMoments& moments : moments_)
        for (const auto& values : {moments.sum, moments.square})
            count += static_cast<std::uint64_t>(std::count(values.begin(), values.end(), kMostSplatSum));
    return count;
}

void SplatSums::add(std::span<const SplatLog::Entry> entries, const SplatCaps& caps) {
    for (const SplatLog::Entry& entry : entries)
        if (entry.slot >= moments_.size()) throw RunError("a splat beyond the film of the pass");
    for (const SplatLog::Entry& entry : entries)
        moments_[entry.slot].add(entry.moments);
    caps_.add(caps);
}

void SplatSums::clear() {
    std::fill(moments_.begin(), moments_.end(), SplatMoments{});
    caps_ = {};
}

Bytes SplatSums::encode() const {
    ByteWriter out;
    out.put_varint(shape_.pixels);
    out.put(shape_.exponent);
    out.put_varint(caps_.capped);
    out.put_varint(caps_.rejected);
    write_half(out, moments_, 0);
    write_half(out, moments_, 1);
    return out.take();
}

void SplatSums::check(std::span<const std::uint8_t> encoded) const {
    read_sums(encoded, shape_, [](std::uint64_t, const SplatMoments&) {});
}

void SplatSums::merge_encoded(std::span<const std::uint8_t> encoded) {
    check(encoded);
    const SplatCaps caps = read_sums(encoded, shape_, [&](std::uint64_t slot, const SplatMoments& moments) {
        moments_[static_cast<std::size_t>(slot)].add(moments);
    });
    caps_.add(caps);
}

}  // namespace treefarm
