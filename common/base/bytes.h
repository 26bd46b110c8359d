// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "common/base/error.h"

namespace treefarm {

static_assert(std::endian::native == std::endian::little, "the wire and file formats are little-endian");

using Bytes = std::vector<std::uint8_t>;

/// Types whose bytes may be sent to another process: fixed width, no padding, no pointers.
template <class T>
concept Wire = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>;

/// Appends little-endian values, varints and length-prefixed blobs.
class ByteWriter {
  public:
    template <Wire T>
    void put(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }

    /// LEB128: 7 bits a byte, low bits first; 1 to 10 bytes. A value has one form: the shortest.
    void put_varint(std::uint64_t value) {
        while (value >= 0x80) {
            bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
            value >>= 7;
        }
        bytes_.push_back(static_cast<std::uint8_t>(value));
    }

    /// A count (varint) followed by the raw elements.
    template <Wire T>
    void put_array(std::span<const T> values) {
        put_varint(values.size());
        const std::size_t at = bytes_.size();
        bytes_.resize(at + values.size_bytes());
        if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
    }

    /// The bytes alone, without their count.
    void put_bytes(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

    void put_string(const std::string& text) { put_array(std::span<const char>(text.data(), text.size())); }

    /// Reserves memory for `more` further bytes, so that appending them copies nothing.
    void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }

    std::size_t size() const { return bytes_.size(); }
    Bytes take() { return std::move(bytes_); }

  private:
    Bytes bytes_;
};

/// Reads what ByteWriter wrote. Every length is checked against what remains before anything is allocated; a short or
/// malformed input throws FormatError.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <Wire T>
    T get() {
        require(sizeof(T));
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }

    std::uint64_t get_varint() {
        // Most varints have one byte: the branch is predicted, and the next varint can be read before this one is
        // decoded.
        if (remaining() > 0 && bytes_[at_] < 0x80) return bytes_[at_++];
        std::uint64_t word;
        if (remaining() >= sizeof word) {
            std::memcpy(&word, bytes_.data() + at_, sizeof word);
            if (const std::uint64_t ends = ~word & 0x8080808080808080u) return get_short_varint(word, ends);
        }
        return get_varint_by_bytes();
    }

    /// Number of elements (varint). Throws FormatError if `min_bytes_each` bytes per element exceed the bytes that
    /// remain.
    std::size_t get_count(std::size_t min_bytes_each) {
        const std::uint64_t count = get_varint();
        if (min_bytes_each > 0 && count > remaining() / min_bytes_each)
            throw FormatError("a count of " + std::to_string(count) + " does not fit into the " +
                              std::to_string(remaining()) + " bytes that remain");
        return static_cast<std::size_t>(count);
    }

    template <Wire T>
    std::vector<T> get_array() {
        const std::size_t count = get_count(sizeof(T));
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(T));
        at_ += count * sizeof(T);
        return values;
    }

    std::string get_string() {
        const std::vector<char> text = get_array<char>();
        return std::string(text.begin(), text.end());
    }

    /// The next `count` bytes; throws FormatError if fewer remain.
    std::span<const std::uint8_t> get_bytes(std::size_t count) {
        require(count);
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }

    std::span<const std::uint8_t> get_rest() {
        const auto rest = bytes_.subspan(at_);
        at_ = bytes_.size();
        return rest;
    }

    std::size_t remaining() const { return bytes_.size() - at_; }

    /// To be called last; bytes that remain mean that writer and reader disagree, and throw FormatError.
    void expect_end() const {
        if (remaining() > 0) throw FormatError(std::to_string(remaining()) + " unexpected bytes at the end");
    }

  private:
    /// Value of a varint of 2 to 8 bytes, whose first byte is the lowest of `word`. In `ends` the high bit is set of
    /// each byte that can be the last one.
    std::uint64_t get_short_varint(std::uint64_t word, std::uint64_t ends) {
        const int high_bit = std::countr_zero(ends);
        if ((word >> (high_bit - 7)) % 256 == 0) throw_overlong();
        at_ += static_cast<std::size_t>(high_bit / 8 + 1);
        word &= (ends & -ends) - 1;
        // Groups of 7 bits become ones of 14, of 28, and one.
        word = (word & 0x007f007f007f007fu) | (word & 0x7f007f007f007f00u) >> 1;
        word = (word & 0x00003fff00003fffu) | (word & 0x3fff00003fff0000u) >> 2;
        return (word & 0x0fffffffu) | (word & 0x0fffffff00000000u) >> 4;
    }

    [[gnu::noinline]] std::uint64_t get_varint_by_bytes() {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            require(1);
            const std::uint8_t byte = bytes_[at_++];
            if (shift == 63 && byte > 1) break;
            if (shift > 0 && byte == 0) throw_overlong();
            value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
            if (byte < 0x80) return value;
        }
        throw FormatError("a variable-length integer has more than 64 bits");
    }

    [[noreturn]] static void throw_overlong() {
        throw FormatError("a variable-length integer is longer than it need be");
    }

    void require(std::size_t count) const {
        if (count > remaining())
            throw FormatError("cut short: " + std::to_string(count) + " bytes expected, " +
                              std::to_string(remaining()) + " remain");
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace treefarm
