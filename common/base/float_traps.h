// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xmmintrin.h>

#include <cstdlib>

namespace treefarm {

/// Floating-point exceptions (invalid, division by zero, overflow) that end the process where they happen. Only in
/// builds of the preset `trap` (CMake's TREEFARM_TRAP, docs/design/testing.md); elsewhere all of this is nothing.
#ifdef TREEFARM_TRAPS
inline constexpr bool kTrapsFloats = true;
#else
inline constexpr bool kTrapsFloats = false;
#endif

/// Keeps float exceptions trapped (or not) in this thread while it lives.
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

/// In such a build, flushes denormals to zero if TREEFARM_FLUSH_DENORMALS stands in the environment.
inline void flush_denormals_if_asked() {
    if constexpr (kTrapsFloats)
        if (std::getenv("TREEFARM_FLUSH_DENORMALS")) _mm_setcsr(_mm_getcsr() | 0x8040u);
}

/// Around our own code.
using TrapFloats = FloatTraps<true>;
/// Around other people's, and where what comes in may be NaN or infinite and is about to be checked.
using LetFloatsBe = FloatTraps<false>;

}  // namespace treefarm
