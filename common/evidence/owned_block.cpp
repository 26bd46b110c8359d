// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/owned_block.h"

#include <algorithm>
#include <string>

namespace treefarm {

void OwnedBlock::set(std::size_t row, std::span<const std::uint64_t> words) {
    const bool fits = row < shape_.rows && words.size() == shape_.columns && !rows_.contains(row) &&
                      std::all_of(words.begin(), words.end(), [&](std::uint64_t word) { return word <= shape_.most; });
    if (!fits) throw RunError("a row of " + std::string(shape_.name) + " that is not the unit's own");
    rows_[row].assign(words.begin(), words.end());
}

std::span<const std::uint64_t> OwnedBlock::row(std::size_t row) const {
    const auto found = rows_.find(row);
    return found == rows_.end() ? std::span<const std::uint64_t>() : found->second;
}

void OwnedBlock::add(const OwnedBlock& other) {
    for (const auto& [row, words] : other.rows_)
        set(row, words);
}

void OwnedBlock::write(ByteWriter& out) const {
    out.put_varint(rows_.size());
    std::size_t next = 0;
    for (const auto& [row, words] : rows_) {
        out.put_varint(row - next);
        next = row + 1;
        for (const std::uint64_t word : words)
            out.put_varint(word);
    }
}

void OwnedBlock::check(ByteReader& in) const {
    const auto refuse = [&](const char* what) {
        throw FormatError(std::string("evidence with ") + what + " in \"" + std::string(shape_.name) + "\"");
    };
    const std::size_t count = in.get_count(1 + shape_.columns);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t skip = in.get_varint();
        if (next == shape_.rows || skip >= shape_.rows - next) refuse("a row beyond its end");
        next += skip;
        if (rows_.contains(next)) refuse("a row that is set already");
        ++next;
        for (std::size_t c = 0; c < shape_.columns; ++c)
            if (in.get_varint() > shape_.most) refuse("a word that is too large");
    }
}

std::uint64_t OwnedBlock::merge(ByteReader& in) {
    const std::size_t count = in.get_count(1);
    std::size_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        next += in.get_varint();
        std::vector<std::uint64_t>& words = rows_[next++];
        for (std::size_t c = 0; c < shape_.columns; ++c)
            words.push_back(in.get_varint());
    }
    return count;
}

}  // namespace treefarm
