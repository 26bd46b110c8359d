// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xmmintrin.h>

#include <cstdlib>

namespace treefarm {

/// Traps of floating-point exceptions (invalid, division by zero, overflow), which end the process at the faulty
/// instruction. Active only in builds of the preset `trap` (CMake's TREEFARM_TRAP, docs/design/testing.md); in other
/// builds everything here is empty.
#ifdef TREEFARM_TRAPS
inline constexpr bool kTrapsFloats = true;
#else
inline constexpr bool kTrapsFloats = false;
#endif

/// Scope that enables (or disables) the traps in its thread.
template <bool kOn>
class FloatTraps {
  public:
    FloatTraps() {
        if constexpr (!kTrapsFloats) return;
        before_ = _mm_getcsr();
        const unsigned without_flags = before_ & ~static_cast<unsigned>(_MM_EXCEPT_MASK);
        _mm_setcsr(kOn ? without_flags & ~kExceptions : without_flags | kExceptions);
    }
    ~FloatTraps() {
        if constexpr (kTrapsFloats) _mm_setcsr(before_);
    }
    FloatTraps(const FloatTraps&) = delete;
    FloatTraps& operator=(const FloatTraps&) = delete;

  private:
    static constexpr unsigned kExceptions = _MM_MASK_INVALID | _MM_MASK_DIV_ZERO | _MM_MASK_OVERFLOW;
    unsigned before_ = 0;
};

/// Flushes denormals to zero in a trap build if the environment variable TREEFARM_FLUSH_DENORMALS is set.
inline void flush_denormals_if_asked() {
    if constexpr (kTrapsFloats)
        if (std::getenv("TREEFARM_FLUSH_DENORMALS")) _mm_setcsr(_mm_getcsr() | 0x8040u);
}

/// Scope of Treefarm's own code.
using TrapFloats = FloatTraps<true>;
/// Scope of library code, and of code that is about to check input for NaN and infinity.
using LetFloatsBe = FloatTraps<false>;

}  // namespace treefarm
