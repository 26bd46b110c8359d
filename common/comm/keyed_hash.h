// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/comm/join_ticket.h"

namespace treefarm {

/// BLAKE2b-256 under a secret, of a purpose and bytes: keys and proofs for one purpose are of no use for another.
JoinKey keyed_hash(const JoinKey& secret, const std::string& purpose, std::span<const std::uint8_t> bytes);

}  // namespace treefarm
