// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

namespace treefarm {

/// Bytes of a huge page of x86-64.
inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Memory of at least kHugePage bytes lies in huge pages where the system grants them, so that look-ups all over a
/// large table do not wait for page tables as well. For tables that live long: to find a huge page free may take a
/// while.
template <class T>
class HugePages {
  public:
    using value_type = T;

    HugePages() = default;
    template <class U>
    HugePages(const HugePages<U>&) {}

    /// Throws std::bad_alloc.
    T* allocate(std::size_t count) {
        if (count > (std::numeric_limits<std::size_t>::max() - kHugePage) / sizeof(T))
            throw std::bad_array_new_length();
        if (!is_large(count)) return static_cast<T*>(::operator new(count * sizeof(T)));
        const std::size_t bytes = (count * sizeof(T) + kHugePage - 1) / kHugePage * kHugePage;
        void* const memory = std::aligned_alloc(kHugePage, bytes);
        if (!memory) throw std::bad_alloc();
        madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: without it pages are small
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) {
        if (is_large(count))
            std::free(memory);
        else
            ::operator delete(memory);
    }

    friend bool operator==(const HugePages&, const HugePages&) { return true; }

  private:
    static bool is_large(std::size_t count) { return count >= kHugePage / sizeof(T); }
};

/// A vector for what is read at random and for long.
template <class T>
using LargeTable = std::vector<T, HugePages<T>>;

}  // namespace treefarm
