// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/comm/join_ticket.h"

namespace treefarm {

/// BLAKE2b-256 under a secret over a purpose and bytes. Keys and proofs for one purpose are useless for another.
JoinKey keyed_hash(const JoinKey& secret, const std::string& purpose, std::span<const std::uint8_t> bytes);

}  // namespace treefarm
