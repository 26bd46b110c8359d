// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/section_file.h"

#include <algorithm>
#include <string>

#include "common/base/hash_stream.h"

namespace treefarm {

namespace {

constexpr std::uint32_t kMagic = section_tag("TFCP"), kEnd = section_tag("END!");
/// Bytes of a section's head (tag, version, length), and of a checksum.
constexpr std::size_t kSectionHead = 16, kCheck = 16;

void put_check(ByteWriter& out, const Hash128& hash) {
    out.put(hash.low);
    out.put(hash.high);
}

Hash128 get_check(ByteReader& in) {
    const auto low = in.get<std::uint64_t>();
    return {low, in.get<std::uint64_t>()};
}

std::string tag_text(std::uint32_t tag) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
        const char letter = static_cast<char>(tag >> 8 * i);
        text += letter > ' ' && letter <= '~' ? letter : '?';
    }
    return text;
}

}  // namespace

bool SectionFile::has(std::uint32_t tag) const {
    return std::any_of(sections.begin(), sections.end(), [&](const Section& section) { return section.tag == tag; });
}

const Section& SectionFile::at(std::uint32_t tag, std::uint32_t version) const {
    for (const Section& section : sections) {
        if (section.tag != tag) continue;
        if (section.version != version)
            throw FormatError("its section " + tag_text(tag) + " has version " + std::to_string(section.version) +
                              ", this program reads " + std::to_string(version));
        return section;
    }
    throw FormatError("its section " + tag_text(tag) + " is missing");
}

std::uint64_t generation_of(std::span<const std::uint8_t, kSectionFileHead> head) {
    ByteReader in(head);
    if (in.get<std::uint32_t>() != kMagic || in.get<std::uint32_t>() != kSectionFileFormat) return 0;
    return in.get<std::uint64_t>();
}

SectionPieces::SectionPieces(const SectionFile& file) {
    ByteWriter out, checks;
    std::vector<std::size_t> ends;  // in `between_`, before each section's bytes
    out.put(kMagic);
    out.put(kSectionFileFormat);
    out.put(file.generation);
    std::uint64_t length = 0;
    for (const Section& section : file.sections) {
        ByteWriter head;
        head.put(section.tag);
        head.put(section.version);
        head.put(static_cast<std::uint64_t>(section.bytes.size()));
        const Bytes bytes = head.take();
        Hash128Stream hash;
        hash.add(bytes);
        hash.add(section.bytes);
        out.put_bytes(bytes);
        ends.push_back(out.size());
        put_check(out, hash.result());
        put_check(checks, hash.result());
        length += section.bytes.size();
    }
    checks.put(file.generation);
    out.put(kEnd);
    out.put(static_cast<std::uint32_t>(file.sections.size()));
    out.put(static_cast<std::uint64_t>(length + out.size() + sizeof(std::uint64_t) + kCheck));
    put_check(out, hash128_bytes(checks.take()));
    between_ = out.take();
    const std::span<const std::uint8_t> between = between_;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        pieces_.push_back(between.subspan(begin, ends[k] - begin));
        pieces_.emplace_back(file.sections[k].bytes);
        begin = ends[k];
    }
    pieces_.push_back(between.subspan(begin));
}

Bytes encode_sections(const SectionFile& file) {
    const SectionPieces in_pieces(file);
    ByteWriter out;
    for (const auto& piece : in_pieces.pieces())
        out.put_bytes(piece);
    return out.take();
}

SectionFile decode_sections(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    if (bytes.size() < kSectionFileHead || in.get<std::uint32_t>() != kMagic) throw FormatError("is no checkpoint");
    if (const auto format = in.get<std::uint32_t>(); format != kSectionFileFormat)
        throw FormatError("has format " + std::to_string(format) + ", this program reads " +
                          std::to_string(kSectionFileFormat));
    SectionFile file;
    file.generation = in.get<std::uint64_t>();
    ByteWriter checks;
    for (;;) {
        const std::size_t begin = bytes.size() - in.remaining();
        if (in.remaining() < kSectionHead + kCheck)
            throw FormatError("is cut off after " + std::to_string(bytes.size()) + " bytes");
        const auto tag = in.get<std::uint32_t>();
        if (tag == kEnd) break;
        Section section{tag, in.get<std::uint32_t>(), {}};
        const auto length = in.get<std::uint64_t>();
        if (length > in.remaining() || in.remaining() - length < kCheck)
            throw FormatError("is cut off at " + std::to_string(bytes.size()) + " of " +
                              std::to_string(begin + kSectionHead + length) + " bytes or more");
        const auto content = in.get_bytes(static_cast<std::size_t>(length));
        const Hash128 check = get_check(in);
        if (check != hash128_bytes(bytes.subspan(begin, kSectionHead + content.size())))
            throw FormatError("is damaged in its section " + tag_text(tag));
        section.bytes.assign(content.begin(), content.end());
        put_check(checks, check);
        file.sections.push_back(std::move(section));
    }
    checks.put(file.generation);
    if (in.get<std::uint32_t>() != file.sections.size() || in.get<std::uint64_t>() != bytes.size() ||
        get_check(in) != hash128_bytes(checks.take()))
        throw FormatError("is damaged at its end");
    in.expect_end();
    return file;
}

}  // namespace treefarm
