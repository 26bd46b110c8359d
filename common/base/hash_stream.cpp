// SPDX-License-Identifier: Apache-2.0
#include "common/base/hash_stream.h"

#include <xxhash.h>

#include <new>

namespace treefarm {

Hash128Stream::Hash128Stream() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
}

void Hash128Stream::add(std::span<const std::uint8_t> bytes) {
    XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
}

Hash128 Hash128Stream::result() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return {hash.low64, hash.high64};
}

void Hash128Stream::Free::operator()(XXH3_state_s* state) const {
    XXH3_freeState(state);
}

}  // namespace treefarm
