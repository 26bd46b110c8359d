#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace treefarm {

/// Calls part(begin, end) for consecutive parts of [0, count) that cover it, side by side on the processors of this
/// machine, at most eight; none is smaller than `least`. For what the coordinator does between passes, while nobody
/// traces: results must not depend on where the parts begin. Throws what a part throws.
template <class Part>
void in_parts(std::size_t count, std::size_t least, const Part& part) {
    constexpr std::size_t kMost = 8;
    const std::size_t processors = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMost);
    const std::size_t parts = std::clamp<std::size_t>(count / least, 1, processors);
    std::vector<std::future<void>> others;
    for (std::size_t k = 1; k < parts; ++k)
        others.push_back(std::async(std::launch::async, [&, k] { part(count * k / parts, count * (k + 1) / parts); }));
    part(std::size_t{0}, count / parts);
    for (std::future<void>& other : others)
        other.get();
}

}  // namespace treefarm
