// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/math/vec.h"
#include "worker/lights/discrete_table.h"

namespace treefarm {

/// A mesh that emits, cut into patches that next event chooses for themselves: near parts of a large one bring more
/// than far ones. Within a patch triangles are chosen by area.
class AreaPatches {
  public:
    /// At most so many, whatever the areas are.
    static constexpr std::size_t kMostPatches = 256;
    /// Patches are not cut further that have so few triangles, or at most this share of the mesh's area.
    static constexpr std::size_t kFewTriangles = 16;
    static constexpr double kSmallShare = 1.0 / 64;

    AreaPatches() = default;  ///< uncut
    /// `center` of each triangle that has an area. A mesh that has few triangles stays uncut.
    AreaPatches(std::span<const double> areas, const std::function<Vec3(std::uint32_t)>& center);

    /// 0: uncut.
    std::uint32_t count() const { return static_cast<std::uint32_t>(tables_.size()); }
    /// Triangles of a patch, in the order in which they are chosen.
    std::span<const std::uint32_t> triangles(std::uint32_t patch) const {
        return std::span(triangles_).subspan(begin_[patch], begin_[patch + 1] - begin_[patch]);
    }
    /// Share of a patch in the area.
    double share(std::uint32_t patch) const { return share_[patch]; }
    /// The patch of a triangle that has an area.
    std::uint32_t patch_of(std::uint32_t triangle) const { return patch_of_[triangle]; }
    /// The triangle of a patch that 32 random bits choose.
    std::uint32_t pick(std::uint32_t patch, std::uint32_t bits) const {
        return triangles_[begin_[patch] + tables_[patch].pick(bits)];
    }
    /// Density per area with which points of a triangle are chosen within its patch, per triangle.
    const std::vector<float>& density() const { return density_; }

  private:
    std::vector<std::uint32_t> triangles_;  ///< of one patch after the other
    std::vector<std::uint32_t> begin_;      ///< of each patch, and their end
    std::vector<DiscreteTable> tables_;     ///< of each patch
    std::vector<double> share_;
    std::vector<float> density_;
    std::vector<std::uint16_t> patch_of_;
};

}  // namespace treefarm
