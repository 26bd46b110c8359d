// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/bytes.h"

namespace treefarm {

/// Part of a checkpoint's file.
struct Section {
    std::uint32_t tag = 0;      ///< four letters (section_tag)
    std::uint32_t version = 1;  ///< of what the bytes mean
    Bytes bytes;

    bool operator==(const Section&) const = default;
};

/// A tag of four letters, as a hex dump shows it.
constexpr std::uint32_t section_tag(const char (&letters)[5]) {
    std::uint32_t tag = 0;
    for (int i = 3; i >= 0; --i)
        tag = tag << 8 | static_cast<std::uint8_t>(letters[i]);
    return tag;
}

/// A file of sections, each with a check sum, that ends in a check sum of those (docs/design/checkpoint.md).
struct SectionFile {
    std::uint64_t generation = 0;  ///< the higher, the newer
    std::vector<Section> sections;

    bool has(std::uint32_t tag) const;
    /// The section with this tag. Throws FormatError if there is none, or it is of another version.
    const Section& at(std::uint32_t tag, std::uint32_t version = 1) const;
};

inline constexpr std::uint32_t kSectionFileFormat = 1;
inline constexpr std::size_t kSectionFileHead = 16;  ///< bytes before the first section

/// The generation that the first bytes of a file say; 0 if it is none.
std::uint64_t generation_of(std::span<const std::uint8_t, kSectionFileHead> head);

/// The bytes of a file, in pieces: what the sections hold lies where it was, for it may be gigabytes.
class SectionPieces {
  public:
    /// `file` has to outlive it.
    explicit SectionPieces(const SectionFile& file);
    SectionPieces(const SectionPieces&) = delete;
    SectionPieces& operator=(const SectionPieces&) = delete;

    std::span<const std::span<const std::uint8_t>> pieces() const { return pieces_; }

  private:
    Bytes between_;  ///< what stands around the sections' bytes
    std::vector<std::span<const std::uint8_t>> pieces_;
};

/// Bytes of the file: all its pieces in a row.
Bytes encode_sections(const SectionFile& file);

/// Throws FormatError, with what is wrong, for anything but the bytes of encode_sections().
SectionFile decode_sections(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
