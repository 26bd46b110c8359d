// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <variant>

namespace treefarm {

/// What a kind asks for that asks for nothing.
struct NoBsdfNeeds {
    using Kept = void;                    ///< what Context::keep() keeps aside for as long as the BSDF lives
    static constexpr bool kCoat = false;  ///< Context::coat() and smooth_escapes() of its roughness and eta
};

/// What make_bsdf() of a kind of material asks its context for, beside the values of the material's inputs. A kind
/// whose make_bsdf() asks for more than its specialisation says does not compile.
template <class Material>
struct BsdfNeeds : NoBsdfNeeds {};

/// Bytes of the largest that a kind of a variant keeps; 1 if none keeps anything.
template <class Kinds>
constexpr std::size_t kMostKept = 1;
template <class... Kinds>
constexpr std::size_t kMostKept<std::variant<Kinds...>> = [] {
    constexpr auto size = []<class Kept>(std::type_identity<Kept>) {
        if constexpr (std::is_void_v<Kept>)
            return std::size_t{1};
        else
            return sizeof(Kept);
    };
    return std::max({size(std::type_identity<typename BsdfNeeds<Kinds>::Kept>())...});
}();

}  // namespace treefarm
