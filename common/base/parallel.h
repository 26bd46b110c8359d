// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace treefarm {

/// Threads that pass over much memory side by side. Beyond eight, memory is what they wait for.
inline unsigned sweeping_threads() {
    return std::clamp(std::thread::hardware_concurrency(), 1u, 8u);
}

/// Calls part(begin, end) for consecutive parts of [0, count) that cover it, side by side by sweeping_threads(); none
/// is smaller than `least`. For what the coordinator does between passes, while nobody
/// traces: results must not depend on where the parts begin. Throws what a part throws.
template <class Part>
void in_parts(std::size_t count, std::size_t least, const Part& part) {
    const std::size_t parts = std::clamp<std::size_t>(count / least, 1, sweeping_threads());
    std::vector<std::future<void>> others;
    for (std::size_t k = 1; k < parts; ++k)
        others.push_back(std::async(std::launch::async, [&, k] { part(count * k / parts, count * (k + 1) / parts); }));
    part(std::size_t{0}, count / parts);
    for (std::future<void>& other : others)
        other.get();
}

}  // namespace treefarm
