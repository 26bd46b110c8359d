// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cereal/cereal.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <type_traits>

#include "common/base/bytes.h"

namespace treefarm {

/// Output archive of cereal over ByteWriter. A message lists its fields once for both directions. ReadArchive checks
/// every count against the bytes that remain before cereal allocates for it.
class WriteArchive : public cereal::OutputArchive<WriteArchive, cereal::AllowEmptyClassElision> {
  public:
    explicit WriteArchive(ByteWriter& writer) : OutputArchive(this), writer_(writer) {}
    ByteWriter& writer() { return writer_; }

  private:
    ByteWriter& writer_;
};

class ReadArchive : public cereal::InputArchive<ReadArchive, cereal::AllowEmptyClassElision> {
  public:
    explicit ReadArchive(ByteReader& reader) : InputArchive(this), reader_(reader) {}
    ByteReader& reader() { return reader_; }

  private:
    ByteReader& reader_;
};

template <Wire T>
void CEREAL_SAVE_FUNCTION_NAME(WriteArchive& archive, const T& value) {
    archive.writer().put(value);
}

template <Wire T>
void CEREAL_LOAD_FUNCTION_NAME(ReadArchive& archive, T& value) {
    value = archive.reader().get<T>();
}

inline void CEREAL_SAVE_FUNCTION_NAME(WriteArchive& archive, const bool& value) {
    archive.writer().put<std::uint8_t>(value ? 1 : 0);
}

inline void CEREAL_LOAD_FUNCTION_NAME(ReadArchive& archive, bool& value) {
    const auto byte = archive.reader().get<std::uint8_t>();
    if (byte > 1) throw FormatError("a truth value of " + std::to_string(byte));
    value = byte == 1;
}

/// Field names are only for formats that people read.
template <class Archive, class T>
void CEREAL_SERIALIZE_FUNCTION_NAME(Archive& archive, cereal::NameValuePair<T>& pair) {
    archive(pair.value);
}

template <class T>
void CEREAL_SAVE_FUNCTION_NAME(WriteArchive& archive, const cereal::SizeTag<T>& tag) {
    archive.writer().put_varint(static_cast<std::uint64_t>(tag.size));
}

/// Number of elements; each takes at least one byte, so a larger count than the bytes that remain is refused.
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(ReadArchive& archive, cereal::SizeTag<T>& tag) {
    tag.size = static_cast<std::remove_reference_t<T>>(archive.reader().get_count(1));
}

template <class T>
void CEREAL_SAVE_FUNCTION_NAME(WriteArchive& archive, const cereal::BinaryData<T>& data) {
    archive.writer().put_bytes({static_cast<const std::uint8_t*>(data.data), static_cast<std::size_t>(data.size)});
}

template <class T>
void CEREAL_LOAD_FUNCTION_NAME(ReadArchive& archive, cereal::BinaryData<T>& data) {
    const auto bytes = archive.reader().get_bytes(static_cast<std::size_t>(data.size));
    std::copy(bytes.begin(), bytes.end(), static_cast<std::uint8_t*>(data.data));
}

}  // namespace treefarm

CEREAL_REGISTER_ARCHIVE(treefarm::WriteArchive)
CEREAL_REGISTER_ARCHIVE(treefarm::ReadArchive)
CEREAL_SETUP_ARCHIVE_TRAITS(treefarm::ReadArchive, treefarm::WriteArchive)
