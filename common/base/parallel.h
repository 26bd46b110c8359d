// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace treefarm {

/// Number of threads for passes over large memory: at most eight, beyond which memory bandwidth is the limit.
inline unsigned sweeping_threads() {
    return std::clamp(std::thread::hardware_concurrency(), 1u, 8u);
}

/// Calls part(begin, end) in parallel on sweeping_threads() threads for consecutive ranges that cover [0, count), each
/// at least `least` long. Used by the coordinator between passes, while no worker traces. Results must not depend on
/// the range boundaries. Rethrows an exception of `part`.
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
