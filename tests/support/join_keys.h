// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/comm/join_ticket.h"

namespace treefarm::test {

/// A key with known bytes.
inline JoinKey key_of(std::uint8_t value) {
    JoinKey key;
    key.fill(value);
    return key;
}

}  // namespace treefarm::test
