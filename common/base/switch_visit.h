// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <variant>

namespace treefarm {

/// Calls f with the value of a variant of at most 24 alternatives. Compiles to a switch with inlinable cases, unlike
/// std::visit: for code that runs per path vertex. All cases must return the same type.
template <class Variant, class F>
[[gnu::always_inline]] inline auto switch_visit(const Variant& variant, F&& f) {
    constexpr std::size_t kCount = std::variant_size_v<Variant>;
    static_assert(kCount <= 24, "add cases");
    using Result = decltype(f(*std::get_if<0>(&variant)));
    // Cases beyond the last alternative repeat the first; no such index occurs.
    const auto of = [&](auto number) -> Result {
        constexpr std::size_t kAt = number < kCount ? number : 0;
        return f(*std::get_if<kAt>(&variant));
    };
    using std::integral_constant;
    switch (variant.index()) {
        case 1:
            return of(integral_constant<std::size_t, 1>());
        case 2:
            return of(integral_constant<std::size_t, 2>());
        case 3:
            return of(integral_constant<std::size_t, 3>());
        case 4:
            return of(integral_constant<std::size_t, 4>());
        case 5:
            return of(integral_constant<std::size_t, 5>());
        case 6:
            return of(integral_constant<std::size_t, 6>());
        case 7:
            return of(integral_constant<std::size_t, 7>());
        case 8:
            return of(integral_constant<std::size_t, 8>());
        case 9:
            return of(integral_constant<std::size_t, 9>());
        case 10:
            return of(integral_constant<std::size_t, 10>());
        case 11:
            return of(integral_constant<std::size_t, 11>());
        case 12:
            return of(integral_constant<std::size_t, 12>());
        case 13:
            return of(integral_constant<std::size_t, 13>());
        case 14:
            return of(integral_constant<std::size_t, 14>());
        case 15:
            return of(integral_constant<std::size_t, 15>());
        case 16:
            return of(integral_constant<std::size_t, 16>());
        case 17:
            return of(integral_constant<std::size_t, 17>());
        case 18:
            return of(integral_constant<std::size_t, 18>());
        case 19:
            return of(integral_constant<std::size_t, 19>());
        case 20:
            return of(integral_constant<std::size_t, 20>());
        case 21:
            return of(integral_constant<std::size_t, 21>());
        case 22:
            return of(integral_constant<std::size_t, 22>());
        case 23:
            return of(integral_constant<std::size_t, 23>());
        default:
            return of(integral_constant<std::size_t, 0>());
    }
}

}  // namespace treefarm
