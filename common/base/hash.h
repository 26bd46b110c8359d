// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace treefarm {

/// XXH3 hash (64 bits) of some bytes: for equality of scenes, trees and images, not for security.
std::uint64_t hash_bytes(std::span<const std::uint8_t> bytes);

/// The hash as 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// XXH3 hash of 128 bits: used where equal hashes are taken for equal bytes.
struct Hash128 {
    std::uint64_t low = 0, high = 0;
    bool operator==(const Hash128&) const = default;
};
Hash128 hash128_bytes(std::span<const std::uint8_t> bytes);

/// The hash as 32 hexadecimal digits.
std::string hash_text(const Hash128& hash);

/// Mixes 64 bits to 64 well-spread bits (the finaliser of MurmurHash3).
inline std::uint64_t mix_bits(std::uint64_t v) {
    v ^= v >> 33;
    v *= 0xff51afd7ed558ccdULL;
    v ^= v >> 33;
    v *= 0xc4ceb9fe1a85ec53ULL;
    v ^= v >> 33;
    return v;
}

}  // namespace treefarm
