// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Fetches the cache line of `address` ahead of a read. Any address is allowed: a prefetch never faults.
inline void prefetch_line(const void* address) {
    __builtin_prefetch(address);
    // GCC 12 takes a function with nothing but a prefetch for pure and drops its calls; an empty asm is an effect
    // without cost.
    asm volatile("");
}

}  // namespace treefarm
