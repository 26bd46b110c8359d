#pragma once

#include <type_traits>

#include "worker/integrator/surface.h"

namespace treefarm {

/// Calls f(std::type_identity<Surface>, guided, record) with types and compile-time booleans: the one place where a
/// pass's switches choose a kernel. Two surfaces, guided or not, recording or not: eight kernels, and four more for
/// describe_sample().
template <class F>
void dispatch(bool plainly_diffuse, bool guided, bool record, F&& f) {
    const auto with_surface = [&](auto surface) {
        const auto with_guided = [&](auto g) {
            record ? f(surface, g, std::true_type{}) : f(surface, g, std::false_type{});
        };
        guided ? with_guided(std::true_type{}) : with_guided(std::false_type{});
    };
    plainly_diffuse ? with_surface(std::type_identity<DiffuseSurface>{})
                    : with_surface(std::type_identity<GeneralSurface>{});
}

}  // namespace treefarm
