// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/sum_block.h"

#include <algorithm>
#include <string>

namespace treefarm {

SumBlock::SumBlock(const BlockShape& shape) : shape_(shape) {
    if (shape_.columns == 0) throw RunError("a block of evidence without columns");
    if (!grows()) values_.resize(shape_.rows * width());
}

std::uint64_t SumBlock::saturated() const {
    return static_cast<std::uint64_t>(std::count(values_.begin(), values_.end(), ~std::uint64_t{0}));
}

void SumBlock::grow(std::size_t rows) {
    values_.resize(std::max(values_.size(), rows * width()));
}

void SumBlock::clear() {
    if (grows())
        values_.clear();
    else
        std::fill(values_.begin(), values_.end(), 0);
}

void SumBlock::add(const SumBlock& other) {
    grow(other.rows());
    for (std::size_t i = 0; i < other.values_.size(); ++i)
        add(i, other.values_[i]);
}

void SumBlock::write(ByteWriter& out, RowRange range) const {
    const std::size_t begin = std::min(range.begin, rows()) * width(), end = std::min(range.end, rows()) * width();
    if (grows()) {
        out.put_varint(end / width());
        for (std::size_t i = 0; i < end; ++i)
            out.put_varint(i < begin ? 0 : values_[i]);
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
        out.put_varint(values_[i]);
        next = i + 1;
    }
}

void SumBlock::refuse(const std::string& what) const {
    throw FormatError("evidence with " + what + " in \"" + std::string(shape_.name) + "\"");
}

/// Reads entries. Calls visit(index, value), and grow(rows) before the first.
template <class Grow, class Visit>
void SumBlock::read(ByteReader& in, Grow grow, Visit visit) const {
    if (grows()) {  // dense: each row takes bytes of the message
        const std::size_t rows = in.get_count(width());
        grow(rows);
        for (std::size_t i = 0; i < rows * width(); ++i)
            visit(i, in.get_varint());
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
        const std::uint64_t value = in.get_varint();
        if (value == 0) refuse("an entry of zero");
        visit(next, value);
        ++next;
    }
}

void SumBlock::check(ByteReader& in, EvidencePart part) const {
    const std::uint64_t most = part == EvidencePart::message ? shape_.most : ~std::uint64_t{0};
    read(
        in, [](std::size_t) {},
        [&](std::uint64_t, std::uint64_t value) {
            if (value > most) refuse("an entry that is too large");
        });
}

std::uint64_t SumBlock::merge(ByteReader& in) {
    std::uint64_t entries = 0;
    read(
        in, [&](std::size_t rows) { grow(rows); },
        [&](std::uint64_t index, std::uint64_t value) {
            ++entries;
            add(index, value);
        });
    return entries;
}

}  // namespace treefarm
