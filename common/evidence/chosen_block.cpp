// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/chosen_block.h"

#include <algorithm>
#include <string>

#include "common/base/hash.h"

namespace treefarm {

ChosenBlock::ChosenBlock(const BlockShape& shape, std::uint64_t key) : shape_(shape), key_(key) {
    if (shape_.rows == 0 || shape_.rows == kGrowingRows) throw RunError("a block of chosen records without a capacity");
}

std::uint64_t ChosenBlock::hash(std::uint64_t name) const {
    return mix_bits(mix_bits(key_ + 0x9e3779b97f4a7c15u) ^ mix_bits(name + 1));
}

void ChosenBlock::offer(std::uint64_t name, std::span<const std::uint32_t> words) {
    if (words.size() != shape_.columns) throw RunError("a record of " + std::string(shape_.name) + " of another size");
    records_.push_back({hash(name), name, words_.size()});
    words_.insert(words_.end(), words.begin(), words.end());
    is_sorted_ = false;
    if (records_.size() >= 2 * most()) cut();
}

void ChosenBlock::cut() const {
    if (is_sorted_) return;
    std::sort(records_.begin(), records_.end());
    if (records_.size() > most()) records_.resize(most());
    std::vector<std::uint32_t> kept;
    kept.reserve(records_.size() * shape_.columns);
    for (Record& record : records_) {
        const auto first = words_.begin() + static_cast<std::ptrdiff_t>(record.words);
        record.words = kept.size();
        kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(shape_.columns));
    }
    words_ = std::move(kept);
    is_sorted_ = true;
}

std::size_t ChosenBlock::size() const {
    cut();
    return std::min(records_.size(), shape_.rows);
}

std::uint64_t ChosenBlock::name(std::size_t record) const {
    cut();
    return records_[record].name;
}

std::span<const std::uint32_t> ChosenBlock::words(std::size_t record) const {
    cut();
    return {words_.data() + records_[record].words, shape_.columns};
}

double ChosenBlock::kept_share() const {
    cut();
    return records_.size() < most() ? 1.0 : static_cast<double>(records_.back().hash) * 0x1p-64;
}

void ChosenBlock::add(const ChosenBlock& other) {
    other.cut();
    for (const Record& record : other.records_)
        offer(record.name, {other.words_.data() + record.words, shape_.columns});
}

void ChosenBlock::write(ByteWriter& out) const {
    cut();
    out.put_varint(records_.size());
    for (const Record& record : records_) {
        out.put(record.name);
        for (std::size_t c = 0; c < shape_.columns; ++c)
            out.put(words_[record.words + c]);
    }
}

void ChosenBlock::check(ByteReader& in) const {
    cut();
    const auto refuse = [&](const char* what) {
        throw FormatError(std::string("evidence with ") + what + " in \"" + std::string(shape_.name) + "\"");
    };
    const std::size_t count = in.get_count(sizeof(std::uint64_t) + shape_.columns * sizeof(std::uint32_t));
    if (count > most()) refuse("more records than are kept");
    Record last{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto name = in.get<std::uint64_t>();
        const Record record{hash(name), name, 0};
        if (i > 0 && !(last < record)) refuse("records out of order");
        if (std::binary_search(records_.begin(), records_.end(), record)) refuse("a record that is there already");
        last = record;
        in.get_bytes(shape_.columns * sizeof(std::uint32_t));
    }
}

std::uint64_t ChosenBlock::merge(ByteReader& in) {
    const std::size_t count = in.get_count(1);
    std::vector<std::uint32_t> words(shape_.columns);
    for (std::size_t i = 0; i < count; ++i) {
        const auto name = in.get<std::uint64_t>();
        for (std::uint32_t& word : words)
            word = in.get<std::uint32_t>();
        offer(name, words);
    }
    return count;
}

bool ChosenBlock::operator==(const ChosenBlock& other) const {
    ByteWriter own, others;
    write(own);
    other.write(others);
    return shape_ == other.shape_ && key_ == other.key_ && own.take() == others.take();
}

}  // namespace treefarm
