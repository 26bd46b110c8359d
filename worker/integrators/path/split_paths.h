// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/path/unguided_estimate.h"

namespace treefarm {

/// How many further paths a path may still be split into, and which of them it is itself. What is left is divided among
/// them, so that all split paths of a camera path are bounded, and none has to know of the others.
struct SplitBudget {
    static constexpr std::uint8_t kMost = 16;

    std::uint8_t number = 0;  ///< among the camera path's split paths; 0: itself
    std::uint8_t left = kMost;

    /// Takes room for `paths` instead of one; returns how many it is for.
    std::uint32_t split(std::uint32_t paths) {
        paths = std::min<std::uint32_t>(paths, left + 1u);
        left = static_cast<std::uint8_t>((left + 1u - paths) / paths);
        return paths;
    }
};

/// Luminance that a path would carry had it not been split: as much as it finds itself, not shared with split paths.
class Unsplit {
  public:
    /// `found`: by the path itself, so far.
    void split(std::uint32_t paths, float found) {
        beside_ = of(found) - found;
        before_ = found;
        paths_ *= static_cast<float>(paths);
    }
    float of(float found) const { return found + beside_ + (paths_ - 1.0f) * (found - before_); }

  private:
    float paths_ = 1.0f;   ///< that it goes on as
    float before_ = 0.0f;  ///< what it had found where it was last split
    float beside_ = 0.0f;  ///< what it would have found besides until there
};

/// One of the paths that a path goes on as, from where its ray has arrived.
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

    /// Random numbers of split paths begin beyond those of any path: its number says where.
    std::uint32_t first_vertex() const {
        return (std::uint32_t{split_budget.number} << 16) + static_cast<std::uint32_t>(depth) - 1;
    }
};

/// Splitting: a path that is expected to carry far more than its first vertex does goes on as several, each with its
/// part (after Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and splitting"). Split paths walk when the
/// paths that left them are done, all together; then those that they leave do. A camera path's split paths are numbered
/// in an order that does not depend on what else walks: by the path that left them, then as it left them.
class SplitPaths {
  public:
    bool empty() const { return left_.empty(); }

    void leave(const SplitPath& path) {
        const auto index = static_cast<std::uint32_t>(left_.size());
        left_.push_back(path);
        order_.push_back(std::uint64_t{path.origin} << 40 | std::uint64_t{path.split_budget.number} << 32 | index);
    }

    /// Paths that were left since the last call, by camera path, numbered on from what `numbers` has of each. They
    /// last until the next call.
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
