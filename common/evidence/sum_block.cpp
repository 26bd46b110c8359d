// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/sum_block.h"

#include <algorithm>
#include <string>

namespace treefarm {
namespace {

/// Signed values with small ones first: 0, -1, 1, -2 become 0, 1, 2, 3.
std::uint64_t zigzag(std::uint64_t value) {
    return value << 1 ^ (0 - (value >> 63));
}
std::uint64_t unzigzag(std::uint64_t value) {
    return value >> 1 ^ (0 - (value & 1));
}

/// Absolute value of a signed one.
std::uint64_t magnitude(std::uint64_t value) {
    return value >> 63 ? 0 - value : value;
}

}  // namespace

SumBlock::SumBlock(const BlockShape& shape) : shape_(shape), values_(grows() ? 0 : shape.rows * shape.columns) {}

void SumBlock::grow(std::size_t rows) {
    values_.resize(std::max(values_.size(), rows * shape_.columns));
}

void SumBlock::clear() {
    if (grows())
        values_.clear();
    else
        std::fill(values_.begin(), values_.end(), 0);
}

std::uint64_t SumBlock::add(const SumBlock& other) {
    grow(other.rows());
    std::uint64_t saturated = 0;
    for (std::size_t i = 0; i < other.values_.size(); ++i)
        if (is_signed())
            values_[i] += other.values_[i];
        else
            saturated += !add(i, other.values_[i]);
    return saturated;
}

std::uint64_t SumBlock::coded(std::size_t index) const {
    return is_signed() ? zigzag(values_[index]) : values_[index];
}

void SumBlock::write(ByteWriter& out, RowRange range) const {
    const std::size_t begin = std::min(range.begin, rows()) * shape_.columns;
    const std::size_t end = std::min(range.end, rows()) * shape_.columns;
    if (grows()) {
        out.put_varint(end / shape_.columns);
        for (std::size_t i = 0; i < end; ++i)
            out.put_varint(i < begin ? 0 : coded(i));
        return;
    }
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i)
        count += values_[i] != 0;
    out.put_varint(count);
    std::size_t next = 0;
    for (std::size_t i = begin; i < end; ++i) {
        if (values_[i] == 0) continue;
        out.put_varint(i - next);
        out.put_varint(coded(i));
        next = i + 1;
    }
}

void SumBlock::refuse(const std::string& what) const {
    throw FormatError("evidence with " + what + " in \"" + std::string(shape_.name) + "\"");
}

std::uint64_t SumBlock::decoded(std::uint64_t coded) const {
    const std::uint64_t value = is_signed() ? unzigzag(coded) : coded;
    if ((is_signed() ? magnitude(value) : value) > shape_.most) refuse("an entry that is too large");
    return value;
}

/// Reads entries. Calls visit(index, value), and grow(rows) before the first.
template <class Grow, class Visit>
void SumBlock::read(ByteReader& in, Grow grow, Visit visit) const {
    if (grows()) {  // dense: a short message cannot claim many rows
        const std::size_t rows = in.get_count(shape_.columns);
        grow(rows);
        for (std::size_t i = 0; i < rows * shape_.columns; ++i)
            visit(i, decoded(in.get_varint()));
        return;
    }
    // Pairs of the distance from the previous index and a value.
    const std::size_t limit = values_.size();
    const std::size_t count = in.get_count(2);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t skip = in.get_varint();
        if (next == limit || skip >= limit - next) refuse("an entry beyond the " + std::to_string(limit));
        next += skip;
        const std::uint64_t coded = in.get_varint();
        if (coded == 0) refuse("an entry of zero");
        visit(next, decoded(coded));
        ++next;
    }
}

void SumBlock::check(ByteReader& in) const {
    read(
        in, [](std::size_t) {}, [](std::uint64_t, std::uint64_t) {});
}

SumBlock::Merged SumBlock::merge(ByteReader& in) {
    Merged merged;
    read(
        in, [&](std::size_t rows) { grow(rows); },
        [&](std::uint64_t index, std::uint64_t value) {
            ++merged.entries;
            if (is_signed())
                values_[index] += value;
            else
                merged.saturated += !add(index, value);
        });
    return merged;
}

}  // namespace treefarm
