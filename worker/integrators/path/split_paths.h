// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/path/unguided_estimate.h"

namespace treefarm {

/// Budget of further splits of a path, and its own number. The remainder is divided among split paths, so that their
/// total per camera path is bounded and none needs to know the others.
struct SplitBudget {
    static constexpr std::uint8_t kMost = 16;

    std::uint8_t number = 0;  ///< number among the camera path's split paths; 0: the camera path itself
    std::uint8_t left = kMost;

    /// Reserves up to `paths` paths in place of one; returns how many were granted.
    std::uint32_t split(std::uint32_t paths) {
        paths = std::min<std::uint32_t>(paths, left + 1u);
        left = static_cast<std::uint8_t>((left + 1u - paths) / paths);
        return paths;
    }
};

/// Luminance that a path would have without splitting: its own contributions, not divided among split paths.
class Unsplit {
  public:
    /// Records a split; `found`: luminance that the path itself has found so far.
    void split(std::uint32_t paths, float found) {
        beside_ = of(found) - found;
        before_ = found;
        paths_ *= static_cast<float>(paths);
    }
    float of(float found) const { return found + beside_ + (paths_ - 1.0f) * (found - before_); }

  private:
    float paths_ = 1.0f;   ///< number of paths as which it continues
    float before_ = 0.0f;  ///< luminance at the last split
    float beside_ = 0.0f;  ///< luminance missing up to the last split, since it was divided
};

/// A path split off from another, starting at the present hit of its ray.
struct SplitPath {
    std::uint16_t origin;
    SplitBudget split_budget;
    int depth;
    Ray ray;
    EmbreeScene::EmbreeHit embree_hit;
    Rgb throughput;
    float spread;
    int first_exponent;
    UnguidedEstimate unguided;

    /// First vertex number of a split path, beyond those of any camera path: it keys its random numbers.
    std::uint32_t first_vertex() const {
        return (std::uint32_t{split_budget.number} << 16) + static_cast<std::uint32_t>(depth) - 1;
    }
};

/// Splitting: a path that is expected to carry far more than its first vertex does continues as several, each with its
/// part (after Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and splitting"). Split paths walk together
/// when the paths that they come from are done; the paths that they split off walk in the next round. The numbers of a
/// camera path's split paths do not depend on other paths: they are ordered by parent path, then by the order of
/// splitting.
class SplitPaths {
  public:
    bool empty() const { return left_.empty(); }

    void leave(const SplitPath& path) {
        const auto index = static_cast<std::uint32_t>(left_.size());
        left_.push_back(path);
        order_.push_back(std::uint64_t{path.origin} << 40 | std::uint64_t{path.split_budget.number} << 32 | index);
    }

    /// Paths that were split off since the last call, sorted by camera path and numbered on from `numbers`, the count
    /// of each. Valid until the next call.
    std::span<const SplitPath> next(std::span<std::uint8_t> numbers) {
        std::sort(order_.begin(), order_.end());
        going_.clear();
        for (const std::uint64_t index : order_) {
            going_.push_back(left_[static_cast<std::uint32_t>(index)]);
            going_.back().split_budget.number = ++numbers[going_.back().origin];
        }
        left_.clear();
        order_.clear();
        return going_;
    }

  private:
    std::vector<SplitPath> left_, going_;
    std::vector<std::uint64_t> order_;
};

}  // namespace treefarm
