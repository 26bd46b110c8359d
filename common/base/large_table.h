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

/// Allocator that requests huge pages for at least kHugePage bytes, so that random look-ups in a large table miss the
/// TLB less often. For long-lived tables: finding a free huge page can take a while.
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
        madvise(memory, bytes, MADV_HUGEPAGE);  // only advice: small pages are the fallback
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

/// Vector for large, long-lived data with random access.
template <class T>
using LargeTable = std::vector<T, HugePages<T>>;

}  // namespace treefarm
