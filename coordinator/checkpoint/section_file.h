// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/bytes.h"

namespace treefarm {

/// A section of a checkpoint file.
struct Section {
    std::uint32_t tag = 0;      ///< four letters (section_tag)
    std::uint32_t version = 1;  ///< version of the bytes' meaning
    Bytes bytes;

    bool operator==(const Section&) const = default;
};

/// Tag of four letters, in the byte order of a hex dump.
constexpr std::uint32_t section_tag(const char (&letters)[5]) {
    std::uint32_t tag = 0;
    for (int i = 3; i >= 0; --i)
        tag = tag << 8 | static_cast<std::uint8_t>(letters[i]);
    return tag;
}

/// A file of sections, each with a checksum, followed by a checksum of those (docs/design/checkpoint.md).
struct SectionFile {
    std::uint64_t generation = 0;  ///< higher means newer
    std::vector<Section> sections;

    bool has(std::uint32_t tag) const;
    /// Section with this tag. Throws FormatError if there is none, or its version differs.
    const Section& at(std::uint32_t tag, std::uint32_t version = 1) const;
};

inline constexpr std::uint32_t kSectionFileFormat = 1;
inline constexpr std::size_t kSectionFileHead = 16;  ///< bytes before the first section

/// Generation in the first bytes of a file; 0 if it is no such file.
std::uint64_t generation_of(std::span<const std::uint8_t, kSectionFileHead> head);

/// Bytes of a file in pieces. The sections' bytes are not copied, since they may be gigabytes.
class SectionPieces {
  public:
    /// `file` must outlive this.
    explicit SectionPieces(const SectionFile& file);
    SectionPieces(const SectionPieces&) = delete;
    SectionPieces& operator=(const SectionPieces&) = delete;

    std::span<const std::span<const std::uint8_t>> pieces() const { return pieces_; }

  private:
    Bytes between_;  ///< bytes around those of the sections
    std::vector<std::span<const std::uint8_t>> pieces_;
};

/// Bytes of the whole file.
Bytes encode_sections(const SectionFile& file);

/// Inverse of encode_sections(). Throws FormatError, with the fault, for any other bytes.
SectionFile decode_sections(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
