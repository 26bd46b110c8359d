// SPDX-License-Identifier: Apache-2.0
#include "common/comm/keyed_hash.h"

#include <sodium.h>

#include "common/base/bytes.h"

namespace treefarm {

JoinKey keyed_hash(const JoinKey& secret, const std::string& purpose, std::span<const std::uint8_t> bytes) {
    ByteWriter writer;
    writer.put_string("treefarm " + purpose);
    writer.put_bytes(bytes);
    const Bytes text = writer.take();
    JoinKey hash;
    static_assert(sizeof hash <= crypto_generichash_BYTES_MAX && sizeof hash >= crypto_generichash_BYTES_MIN);
    crypto_generichash(hash.data(), hash.size(), text.data(), text.size(), secret.data(), secret.size());
    return hash;
}

}  // namespace treefarm
