#pragma once

#include <type_traits>

namespace treefarm {

/// Calls f with three compile-time booleans: the one place where a pass's switches choose a kernel.
template <class F>
void dispatch(bool a, bool b, bool c, F&& f) {
    const auto with = [&](auto ka) {
        const auto with_b = [&](auto kb) { c ? f(ka, kb, std::true_type{}) : f(ka, kb, std::false_type{}); };
        b ? with_b(std::true_type{}) : with_b(std::false_type{});
    };
    a ? with(std::true_type{}) : with(std::false_type{});
}

}  // namespace treefarm
