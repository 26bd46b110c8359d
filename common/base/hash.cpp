// SPDX-License-Identifier: Apache-2.0
#include "common/base/hash.h"

#include <xxhash.h>

#include <cstdio>

namespace treefarm {

std::uint64_t hash_bytes(std::span<const std::uint8_t> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

Hash128 hash128_bytes(std::span<const std::uint8_t> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return {hash.low64, hash.high64};
}

std::string hash_text(const Hash128& hash) {
    return hash_text(hash.high) + hash_text(hash.low);
}

}  // namespace treefarm
