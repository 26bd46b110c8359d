// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Fetches the line of cache that `address` lies in, for a read to come. The address may be any: none faults.
inline void prefetch_line(const void* address) {
    __builtin_prefetch(address);
    // GCC 12 takes a function that does nothing else for pure, and drops calls of it: this is an effect, of no cost.
    asm volatile("");
}

}  // namespace treefarm
