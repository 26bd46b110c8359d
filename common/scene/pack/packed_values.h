// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "common/base/bytes.h"
#include "common/math/vec.h"
#include "common/scene/kinds/traits/inputs.h"

namespace treefarm::packed {

/// Codecs of values that several parts of the packed scene have. Readers throw FormatError.

template <class V>
void put_vector(ByteWriter& out, const V& v) {
    for (unsigned i = 0; i < V::dimensions(); ++i)
        out.put(v[static_cast<int>(i)]);
}

template <class V>
V get_vector(ByteReader& in) {
    V v;
    for (unsigned i = 0; i < V::dimensions(); ++i)
        v[static_cast<int>(i)] = in.get<float>();
    return v;
}

/// Vectors whose memory equals their packed form: their components in single precision, and nothing else.
template <class V>
concept PlainVector = std::is_standard_layout_v<V> && sizeof(V) == V::dimensions() * sizeof(float);

/// Writes a varint count and the bytes of all vectors in one piece, since meshes are large.
template <PlainVector V>
void put_vectors(ByteWriter& out, const std::vector<V>& values) {
    out.put_varint(values.size());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    out.put_bytes({bytes, values.size() * sizeof(V)});
}

template <PlainVector V>
std::vector<V> get_vectors(ByteReader& in) {
    std::vector<V> values(in.get_count(sizeof(V)));
    const auto bytes = in.get_bytes(values.size() * sizeof(V));
    if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
}

inline void put_flag(ByteWriter& out, bool flag) {
    out.put<std::uint8_t>(flag ? 1 : 0);
}

inline bool get_flag(ByteReader& in, const char* what) {
    const auto flag = in.get<std::uint8_t>();
    if (flag > 1) throw FormatError(std::string("scene: ") + what + " is neither 0 nor 1");
    return flag == 1;
}

template <class Enum>
void put_enum(ByteWriter& out, Enum value) {
    out.put(static_cast<std::uint8_t>(value));
}

template <class Enum>
Enum get_enum(ByteReader& in, Enum last, const char* what) {
    const auto value = in.get<std::uint8_t>();
    if (value > static_cast<std::uint8_t>(last))
        throw FormatError("scene: unknown " + std::string(what) + " " + std::to_string(value));
    return static_cast<Enum>(value);
}

/// Reads an index below `count`.
inline std::int32_t get_index(ByteReader& in, std::size_t count, const char* what) {
    const auto index = in.get<std::int32_t>();
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        throw FormatError("scene: " + std::string(what) + " " + std::to_string(index) + " of " + std::to_string(count));
    return index;
}

/// Reads an index below `count`, or kNone.
inline std::int32_t get_optional_index(ByteReader& in, std::size_t count, const char* what) {
    const auto index = in.get<std::int32_t>();
    if (index == kNone) return index;
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        throw FormatError("scene: " + std::string(what) + " " + std::to_string(index) + " of " + std::to_string(count));
    return index;
}

inline void put_location(ByteWriter& out, const Location& where) {
    out.put_string(where.file);
    out.put<std::int32_t>(where.line);
    out.put<std::int32_t>(where.column);
}

inline Location get_location(ByteReader& in) {
    Location where;
    where.file = in.get_string();
    where.line = in.get<std::int32_t>();
    where.column = in.get<std::int32_t>();
    return where;
}

inline void put_color(ByteWriter& out, const ColorInput& input) {
    put_vector(out, input.value);
    out.put(input.texture);
}

inline ColorInput get_color(ByteReader& in, std::size_t texture_count) {
    const Rgb value = get_vector<Rgb>(in);
    return {value, get_optional_index(in, texture_count, "texture")};
}

inline void put_number(ByteWriter& out, const FloatInput& input) {
    out.put(input.value);
    out.put(input.texture);
}

inline FloatInput get_number(ByteReader& in, std::size_t texture_count) {
    const auto value = in.get<float>();
    return {value, get_optional_index(in, texture_count, "texture")};
}

/// Reads a varint count and the elements, each of at least `min_bytes`. `get` may use the elements before.
template <class T, class Get>
void get_list(ByteReader& in, std::size_t min_bytes, std::vector<T>& values, Get get) {
    const std::size_t count = in.get_count(min_bytes);
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(get());
}

template <class T, class Put>
void put_list(ByteWriter& out, const std::vector<T>& values, Put put) {
    out.put_varint(values.size());
    for (const T& value : values)
        put(out, value);
}

}  // namespace treefarm::packed
