// SPDX-License-Identifier: Apache-2.0
#include "common/decide/emission/emission_shares.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/math/saturating.h"

namespace treefarm {

void EmissionSums::add(const EmissionSums& other) {
    resize(std::max(size(), other.size()));
    for (std::size_t i = 0; i < other.size(); ++i) {
        add_saturating(paths[i], other.paths[i]);
        add_saturating(squares[i], other.squares[i]);
        squares[i] = std::min(squares[i], kMostSplatSum);
    }
}

std::vector<float> emission_emphasis(const EmissionSums& sums) {
    double paths = 0, squares = 0;
    for (std::size_t i = 0; i < sums.paths.size(); ++i) {
        paths += static_cast<double>(sums.paths[i]);
        squares += static_cast<double>(sums.squares[i]);
    }
    if (sums.paths.size() < 2 || !(squares > 0)) return {};
    // An emitter of which little is known is taken to be as all are: so many paths count as if they had brought that.
    constexpr double kPrior = 128.0;
    const double usual = squares / paths;
    std::vector<float> emphasis;
    emphasis.reserve(sums.paths.size());
    for (std::size_t i = 0; i < sums.paths.size(); ++i)
        emphasis.push_back(static_cast<float>(std::sqrt((static_cast<double>(sums.squares[i]) / usual + kPrior) /
                                                        (static_cast<double>(sums.paths[i]) + kPrior))));
    return emphasis;
}

std::size_t emitters_of_half(const EmissionSums& sums) {
    std::vector<std::uint64_t> paths = sums.paths;
    std::sort(paths.begin(), paths.end(), std::greater<>());
    std::uint64_t all = 0;
    for (const std::uint64_t count : paths)
        add_saturating(all, count);
    std::uint64_t seen = 0;
    std::size_t count = 0;
    while (count < paths.size() && seen < all - all / 2)
        add_saturating(seen, paths[count++]);
    return count;
}

}  // namespace treefarm
