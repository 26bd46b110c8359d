// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Where a ray meets a scene first.
struct FirstHit {
    double distance = 0;
    std::size_t shape = 0;  ///< that was hit; of an instance, the part of its group
    bool behind = false;    ///< from the side against the normal
};

/// Rays against shapes one by one, without a hierarchy: for a few hundred rays that tell what lies where. Masks are not
/// looked up. The scene's indices exist, and it outlives this.
class FirstHitSearch {
  public:
    explicit FirstHitSearch(const Scene& scene);

    /// `direction` is of length 1.
    std::optional<FirstHit> find(const Imath::V3d& origin, const Imath::V3d& direction) const;

  private:
    const Scene& scene_;
    std::vector<Box3> boxes_;              ///< of the shapes' own surfaces
    std::vector<Imath::M44d> from_world_;  ///< per shape; of instances only
};

}  // namespace treefarm
