// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/error.h"
#include "common/evidence/block_shape.h"
#include "common/film/splat_film.h"

namespace treefarm {

/// Probability with which light paths start at each emitter, from the contributions of earlier passes: noise is least
/// if an emitter is chosen in proportion to the root of its paths' second moment (docs/design/transport.md). Computed
/// from exact sums and fixed during a pass, so it does not depend on the farm.

/// Contributions of light paths, by the entry of the emission table at which each started; empty unless
/// requested.
struct EmissionSums {
    std::vector<std::uint64_t> paths;
    /// Squares of the contribution of each path, as if emitters were chosen by power; saturates at kMostSplatSum.
    std::vector<std::uint64_t> squares;

    static constexpr BlockShape kBlock{"emission",   "paths, squared quanta", BlockKind::sums, kGrowingRows, 2,
                                       kMostSplatSum};
    template <class Sums, class Visit>
    static constexpr void each(Sums& sums, Visit visit) {
        for (std::size_t i = 0; i < sums.size(); ++i) {
            visit(sums.paths[i]);
            visit(sums.squares[i]);
        }
    }
    std::size_t size() const { return paths.size(); }
    void resize(std::size_t emitters) {
        paths.resize(emitters);
        squares.resize(emitters);
    }
    void add(const EmissionSums& other);

    template <class Archive>
    void serialize(Archive& archive) {
        archive(paths, squares);
        if (Archive::is_loading::value && paths.size() != squares.size())
            throw FormatError("light paths without their splats");
    }
};

/// Factor of each entry's probability by power, before normalisation; empty if there are no data, or no choice.
std::vector<float> emission_emphasis(const EmissionSums& sums);

/// Least number of emitters that started at least half of the light paths; 0 if not counted.
std::size_t emitters_of_half(const EmissionSums& sums);

}  // namespace treefarm
