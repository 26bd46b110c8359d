// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// First hit of a ray in a scene.
struct FirstHit {
    double distance = 0;
    std::size_t shape = 0;  ///< index of the shape; for an instance, of the member of its group
    bool behind = false;    ///< hit on the side opposite to the normal
    Imath::V3d normal;      ///< of the surface there, of any length and side
};

/// Intersects rays with shapes one by one, without a hierarchy: for a few hundred rays. Masks are ignored. The scene's
/// indices must exist, and it must outlive this.
class FirstHitSearch {
  public:
    explicit FirstHitSearch(const Scene& scene);

    /// `direction`: of length 1.
    std::optional<FirstHit> find(const Imath::V3d& origin, const Imath::V3d& direction) const;

  private:
    const Scene& scene_;
    std::vector<Box3> boxes_;              ///< of the shapes' own surfaces
    std::vector<Imath::M44d> from_world_;  ///< per shape; of instances only
};

}  // namespace treefarm
