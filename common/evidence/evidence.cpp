// SPDX-License-Identifier: Apache-2.0
#include "common/evidence/evidence.h"

#include <string>

namespace treefarm {

Bytes encode_evidence(std::uint32_t pass, std::span<const Blocks* const> owners) {
    ByteWriter out;
    out.put_varint(pass);
    for (const Blocks* const blocks : owners)
        blocks->write(out);
    return out.take();
}

Bytes Evidence::encode() const {
    std::vector<const Blocks*> owners;
    for (const Blocks& blocks : owners_)
        owners.push_back(&blocks);
    return encode_evidence(pass_, owners);
}

std::vector<std::uint64_t> Evidence::merge_encoded(std::span<const std::uint8_t> bytes, EvidencePart part) {
    std::vector<Blocks*> owners;
    for (Blocks& blocks : owners_)
        owners.push_back(&blocks);
    return merge_evidence(pass_, owners, bytes, part);
}

std::vector<std::uint64_t> merge_evidence(std::uint32_t pass, std::span<Blocks* const> owners,
                                          std::span<const std::uint8_t> bytes, EvidencePart part) {
    // Two readings: the first only checks, so that a malformed part changes nothing.
    ByteReader checked(bytes);
    if (const std::uint64_t told = checked.get_varint(); told != pass)
        throw FormatError("evidence of pass " + std::to_string(told) + " instead of " + std::to_string(pass));
    for (const Blocks* const blocks : owners)
        blocks->check(checked, part);
    checked.expect_end();

    ByteReader in(bytes);
    in.get_varint();
    std::vector<std::uint64_t> entries;
    for (Blocks* const blocks : owners)
        entries.push_back(blocks->merge(in));
    return entries;
}

}  // namespace treefarm
