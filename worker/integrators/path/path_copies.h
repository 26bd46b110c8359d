// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "worker/geometry/embree_scene.h"

namespace treefarm {

/// How many copies a path may still leave, and which copy it is itself. What is left is shared with each copy, so that
/// all copies of a camera path are bounded, and none has to know of the others.
struct CopyBudget {
    static constexpr std::uint8_t kMost = 16;

    std::uint8_t number = 0;  ///< of the camera path's copies; 0: no copy
    std::uint8_t left = kMost;

    /// Takes place for `paths` instead of one; returns how many it is for.
    std::uint32_t split(std::uint32_t paths) {
        paths = std::min<std::uint32_t>(paths, left + 1u);
        left = static_cast<std::uint8_t>((left + 1u - paths) / paths);
        return paths;
    }
};

/// Luminance that a path would carry had it not been split: as much as it finds itself, not shared with copies.
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
struct PathCopy {
    std::uint16_t origin;
    CopyBudget copies;
    int depth;
    Ray ray;
    EmbreeScene::Meeting meeting;
    Rgb throughput;
    float spread;
    int first_exponent;

    /// Random numbers of copies begin beyond those of any path: its number says where.
    std::uint32_t first_vertex() const {
        return (std::uint32_t{copies.number} << 16) + static_cast<std::uint32_t>(depth) - 1;
    }
};

/// Splitting: a path that is expected to carry far more than its first vertex does goes on as several, each with its
/// share (after Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and splitting"). Copies walk when the paths
/// that left them are done, all together; then the copies' copies do. A camera path's copies are numbered in an order
/// that does not depend on its company: by the path that they left, then as it left them.
class PathCopies {
  public:
    bool empty() const { return left_.empty(); }

    void leave(const PathCopy& copy) {
        const auto place = static_cast<std::uint32_t>(left_.size());
        left_.push_back(copy);
        order_.push_back(std::uint64_t{copy.origin} << 40 | std::uint64_t{copy.copies.number} << 32 | place);
    }

    /// Copies that were left since the last call, by camera path, numbered on from what `numbers` has of each. They
    /// last until the next call.
    std::span<const PathCopy> next(std::span<std::uint8_t> numbers) {
        std::sort(order_.begin(), order_.end());
        going_.clear();
        for (const std::uint64_t place : order_) {
            going_.push_back(left_[static_cast<std::uint32_t>(place)]);
            going_.back().copies.number = ++numbers[going_.back().origin];
        }
        left_.clear();
        order_.clear();
        return going_;
    }

  private:
    std::vector<PathCopy> left_, going_;
    std::vector<std::uint64_t> order_;
};

}  // namespace treefarm
