// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <variant>

namespace treefarm {

/// Needs of a kind of material that needs nothing from its context.
struct NoBsdfNeeds {
    using Kept = void;  ///< inputs that Context::keep() stores for as long as the BSDF lives
    /// whether it calls Context::coat() and smooth_escapes() for its roughness and eta
    static constexpr bool kCoat = false;
};

/// Needs of a material kind's make_bsdf() from its context, beside the values of its inputs. A make_bsdf() that uses
/// more than its specialisation states does not compile.
template <class Material>
struct BsdfNeeds : NoBsdfNeeds {};

/// Largest size in bytes of the inputs that a kind of a variant keeps; 1 if none does.
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
