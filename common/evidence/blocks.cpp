// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/blocks.h"

#include <algorithm>

namespace treefarm {
namespace {

/// Rows of a declaration as a message tells them: 0 for any number.
std::size_t told_rows(const BlockShape& shape) {
    return shape.rows == kGrowingRows ? 0 : shape.rows;
}

/// Reads the size of a block, which must be that of ours.
void expect_size(ByteReader& in, const BlockShape& shape) {
    if (const std::uint64_t told = in.get_varint(); told != told_rows(shape))
        throw FormatError("evidence with " + std::to_string(told) + " rows of \"" + std::string(shape.name) +
                          "\" instead of " + std::to_string(told_rows(shape)));
}

}  // namespace

Blocks::Blocks(std::span<const BlockShape> shapes, std::uint64_t key) {
    for (const BlockShape& shape : shapes) {
        if (shape.kind == BlockKind::chosen)
            chosen_.emplace_back(shape, key);
        else if (shape.kind == BlockKind::owned)
            owned_.emplace_back(shape);
        else
            sums_.emplace_back(shape);
    }
}

void Blocks::clear() {
    for (SumBlock& block : sums_)
        block.clear();
    for (ChosenBlock& block : chosen_)
        block.clear();
    for (OwnedBlock& block : owned_)
        block.clear();
}

std::uint64_t Blocks::saturated() const {
    std::uint64_t count = 0;
    for (const SumBlock& block : sums_)
        count += block.saturated();
    return count;
}

void Blocks::add(const Blocks& other) {
    const auto alike = [](const auto& blocks, const auto& others) {
        return std::equal(blocks.begin(), blocks.end(), others.begin(), others.end(),
                          [](const auto& a, const auto& b) { return a.shape() == b.shape(); });
    };
    if (!alike(sums_, other.sums_) || !alike(chosen_, other.chosen_) || !alike(owned_, other.owned_))
        throw RunError("evidence of different shapes cannot be added");
    for (std::size_t i = 0; i < sums_.size(); ++i)
        sums_[i].add(other.sums_[i]);
    for (std::size_t i = 0; i < chosen_.size(); ++i)
        chosen_[i].add(other.chosen_[i]);
    for (std::size_t i = 0; i < owned_.size(); ++i)
        owned_[i].add(other.owned_[i]);
}

void Blocks::write(ByteWriter& out) const {
    const auto write_each = [&](const auto& blocks) {
        for (const auto& block : blocks) {
            out.put_varint(told_rows(block.shape()));
            block.write(out);
        }
    };
    write_each(sums_);
    write_each(chosen_);
    write_each(owned_);
}

void Blocks::check(ByteReader& in, EvidencePart part) const {
    for (const SumBlock& block : sums_) {
        expect_size(in, block.shape());
        block.check(in, part);
    }
    for (const ChosenBlock& block : chosen_) {
        expect_size(in, block.shape());
        block.check(in);
    }
    for (const OwnedBlock& block : owned_) {
        expect_size(in, block.shape());
        block.check(in);
    }
}

std::uint64_t Blocks::merge(ByteReader& in) {
    std::uint64_t touched = 0;
    for (SumBlock& block : sums_) {
        in.get_varint();
        const std::uint64_t entries = block.merge(in);
        if (&block == sums_.data()) touched = entries;
    }
    for (ChosenBlock& block : chosen_) {
        in.get_varint();
        block.merge(in);
    }
    for (OwnedBlock& block : owned_) {
        in.get_varint();
        block.merge(in);
    }
    return touched;
}

}  // namespace treefarm
