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

    /// The section with this tag. Throws FormatError if there is none, or it is of another version.
    const Section& at(std::uint32_t tag, std::uint32_t version = 1) const;
};

inline constexpr std::uint32_t kSectionFileFormat = 1;
inline constexpr std::size_t kSectionFileHead = 16;  ///< bytes before the first section

/// The generation that the first bytes of a file say; 0 if it is none.
std::uint64_t generation_of(std::span<const std::uint8_t, kSectionFileHead> head);

Bytes encode_sections(const SectionFile& file);

/// Throws FormatError, with what is wrong, for anything but the bytes of encode_sections().
SectionFile decode_sections(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
