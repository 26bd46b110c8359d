// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text/parse_text.h"
#include "coordinator/input/meshes/ply_header.h"

namespace treefarm::ply {

/// Values of a text file, one element per line.
class TextValues {
  public:
    TextValues(std::string_view bytes, const Header& header, const std::string& file)
        : bytes_(bytes), file_(file), at_(header.body), line_(header.body_line), line_start_(header.body) {}

    /// Upper bound of the values left: each has a digit, and all but the last a space.
    std::uint64_t most_values(Type) const { return (bytes_.size() - at_ + 1) / 2; }

    double number(Type) {
        const std::string_view word = next_word();
        if (const auto value = parse_number(word)) return *value;
        refuse(in_quotes(word) + " is not a number", "write a finite decimal number");
    }

    /// The next number; NaN for a word that is none.
    double any_number(Type) { return parse_number(next_word()).value_or(std::numeric_limits<double>::quiet_NaN()); }

    std::int64_t integer(Type) {
        const std::string_view word = next_word();
        if (const auto value = parse_integer(word)) return *value;
        refuse(in_quotes(word) + " is not an integer", "write an integer");
    }

    void skip(Type) { next_word(); }

    void end_element() {
        skip_blanks();
        if (at_ < bytes_.size() && bytes_[at_] != '\n') {
            word_at_ = at_;
            refuse("there are more values in this line than the header says", "repair the line or the header");
        }
        if (at_ < bytes_.size()) new_line();
    }

    /// Refuses the file unless only white space is left.
    void end() {
        while (at_ < bytes_.size()) {
            skip_blanks();
            if (at_ >= bytes_.size()) return;
            if (bytes_[at_] != '\n') {
                word_at_ = at_;
                refuse("there is more in the file than the header says", "repair the header");
            }
            new_line();
        }
    }

    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError({file_, line_, static_cast<int>(word_at_ - line_start_) + 1}, what, cure);
    }

  private:
    void skip_blanks() {
        while (at_ < bytes_.size() && (bytes_[at_] == ' ' || bytes_[at_] == '\t' || bytes_[at_] == '\r'))
            ++at_;
    }

    void new_line() {
        ++at_;
        ++line_;
        line_start_ = at_;
    }

    std::string_view next_word() {
        skip_blanks();
        word_at_ = at_;
        const auto ends = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        while (at_ < bytes_.size() && !ends(bytes_[at_]))
            ++at_;
        if (at_ == word_at_) refuse("a value is missing here", "the file is cut short: repair it");
        return bytes_.substr(word_at_, at_ - word_at_);
    }

    std::string_view bytes_;
    const std::string& file_;
    std::size_t at_, word_at_ = 0;
    int line_;
    std::size_t line_start_;
};

/// Values of a binary file.
class BinaryValues {
  public:
    BinaryValues(std::string_view bytes, const Header& header, const std::string& file)
        : bytes_(bytes), file_(file), at_(header.body), big_endian_(header.format == Format::big_endian) {}

    std::uint64_t most_values(Type type) const { return (bytes_.size() - at_) / size_of(type); }

    double number(Type type) {
        switch (type) {
            case Type::float32:
                return static_cast<double>(get<float, std::uint32_t>());
            case Type::float64:
                return get<double, std::uint64_t>();
            default:
                return static_cast<double>(integer(type));
        }
    }

    double any_number(Type type) { return number(type); }

    /// The next value of an integer type.
    std::int64_t integer(Type type) {
        switch (type) {
            case Type::int8:
                return get<std::int8_t, std::uint8_t>();
            case Type::uint8:
                return get<std::uint8_t, std::uint8_t>();
            case Type::int16:
                return get<std::int16_t, std::uint16_t>();
            case Type::uint16:
                return get<std::uint16_t, std::uint16_t>();
            case Type::int32:
                return get<std::int32_t, std::uint32_t>();
            default:
                return get<std::uint32_t, std::uint32_t>();
        }
    }

    void skip(Type type) {
        require(size_of(type));
        at_ += size_of(type);
    }

    void end_element() {}

    /// Refuses the file unless only white space is left: some programs end binary files with a line end.
    void end() {
        for (; at_ < bytes_.size(); ++at_)
            if (bytes_[at_] != '\n' && bytes_[at_] != '\r') {
                value_at_ = at_;
                refuse("there is more in the file than the header says", "repair the header");
            }
    }

    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError({file_}, what + " (at byte " + std::to_string(value_at_) + ")", cure);
    }

  private:
    void require(std::size_t size) {
        value_at_ = at_;
        if (size > bytes_.size() - at_) refuse("a value is missing", "the file is cut short: repair it");
    }

    template <class T, class Unsigned>
    T get() {
        require(sizeof(T));
        Unsigned bits = 0;
        if (big_endian_)
            for (std::size_t i = 0; i < sizeof(T); ++i)
                bits = static_cast<Unsigned>(std::uint64_t{bits} << 8 | static_cast<std::uint8_t>(bytes_[at_ + i]));
        else
            std::memcpy(&bits, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return std::bit_cast<T>(bits);
    }

    std::string_view bytes_;
    const std::string& file_;
    std::size_t at_, value_at_ = 0;
    bool big_endian_;
};

}  // namespace treefarm::ply
