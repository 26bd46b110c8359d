// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/base/hash.h"

struct XXH3_state_s;

namespace treefarm {

/// XXH3 with 128 bits of bytes that come in pieces: hash128_bytes() of all of them in a row.
class Hash128Stream {
  public:
    Hash128Stream();

    void add(std::span<const std::uint8_t> bytes);
    Hash128 result() const;

  private:
    struct Free {
        void operator()(XXH3_state_s* state) const;
    };
    std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace treefarm
