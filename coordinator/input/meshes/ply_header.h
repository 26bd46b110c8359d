// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace treefarm::ply {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in a binary file.
std::size_t size_of(Type type);
bool is_integer(Type type);

struct Property {
    std::string name;
    Type type = Type::float32;  ///< of the value, or of a list's values
    bool is_list = false;
    Type count_type = Type::uint8;  ///< of a list's length
    int line = 0;                   ///< line of its declaration
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    int line = 0;

    /// Least bytes of an element in the file: lists are empty; numbers in text have a digit and a space.
    std::size_t min_bytes(bool ascii) const;
    /// The first property with one of these names, or nullptr.
    const Property* find(std::initializer_list<std::string_view> names) const;
};

enum class Format : std::uint8_t { ascii, little_endian, big_endian };

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t body = 0;  ///< byte at which the data begin
    int body_line = 0;     ///< line at which the data begin
};

/// Reads the header of a PLY file. Counts are checked against the bytes that follow. Throws InputError with the line.
Header parse_header(std::string_view file_bytes, const std::string& file);

}  // namespace treefarm::ply
