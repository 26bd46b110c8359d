// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/base/hash.h"

struct XXH3_state_s;

namespace treefarm {

/// XXH3 hash of 128 bits over bytes that arrive in pieces; equals hash128_bytes() of their concatenation.
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
