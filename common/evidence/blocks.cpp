// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/blocks.h"

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
    saturated_ = 0;
}

void Blocks::add(const Blocks& other) {
    const auto add_each = [](auto& blocks, const auto& others, auto add) {
        bool same = blocks.size() == others.size();
        for (std::size_t i = 0; same && i < blocks.size(); ++i)
            same = blocks[i].shape() == others[i].shape();
        if (!same) throw RunError("evidence of different shapes cannot be added");
        for (std::size_t i = 0; i < blocks.size(); ++i)
            add(blocks[i], others[i]);
    };
    add_each(sums_, other.sums_, [&](SumBlock& a, const SumBlock& b) { saturated_ += a.add(b); });
    add_each(chosen_, other.chosen_, [](ChosenBlock& a, const ChosenBlock& b) { a.add(b); });
    add_each(owned_, other.owned_, [](OwnedBlock& a, const OwnedBlock& b) { a.add(b); });
    add_saturating(saturated_, other.saturated_);
}

void Blocks::write(ByteWriter& out) const {
    out.put_varint(saturated_);
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

void Blocks::check(ByteReader& in) const {
    if (in.get_varint() > kMostClaim) throw FormatError("evidence with a count that is too large");
    const auto check_each = [&](const auto& blocks) {
        for (const auto& block : blocks) {
            expect_size(in, block.shape());
            block.check(in);
        }
    };
    check_each(sums_);
    check_each(chosen_);
    check_each(owned_);
}

std::uint64_t Blocks::merge(ByteReader& in) {
    std::uint64_t touched = 0;
    saturated_ += in.get_varint();
    for (SumBlock& block : sums_) {
        in.get_varint();
        const SumBlock::Merged merged = block.merge(in);
        saturated_ += merged.saturated;
        if (&block == sums_.data()) touched = merged.entries;
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
