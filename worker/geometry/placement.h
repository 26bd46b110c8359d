// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"
#include "worker/geometry/hit.h"
#include "worker/geometry/surface_detail.h"

namespace treefarm {

/// Transform of an instance: maps hits from the group's space to the world.
///
/// Normals keep their side: the group's front is the front in the world, mirrored or not.
class Placement {
  public:
    /// Throws RunError if the transform cannot be inverted.
    Placement(const Instance& instance, std::uint32_t shape);

    std::uint32_t group() const { return group_; }

    /// World-space form of a local hit. Its error includes the rounding of the ray's transform into the group's space:
    /// Embree inverts the transform in single precision.
    Hit to_world(const Hit& local) const;
    /// Unit normal in the group's space, from a world-space one.
    Vec3 normal_to_local(const Vec3& world) const;
    Vec3 vector_to_world(const Vec3& local) const;

    // In double: as accurate as the transform's floats allow.
    Imath::V3d point_to_world(const Imath::V3d& local) const;
    Imath::V3d point_to_local(const Imath::V3d& world) const;
    /// Vector w with dot(w, x) = dot(normal, x to_world) for vectors x of the group's space.
    Imath::V3d covector_to_local(const Imath::V3d& normal) const;
    /// Lower bound of the factor by which the transform stretches a vector.
    double least_stretch() const;
    /// Upper bound of the factor by which the transform stretches a vector.
    double most_stretch() const;

  private:
    Imath::M44f to_world_;
    Imath::M33d exact_inverse_;
    Imath::M33f inverse_;  ///< of the linear part: row vectors of the world to those of the group
    Imath::M33f slack_;    ///< bound of each term's error in the group's space, per unit of world coordinate
    std::uint32_t group_ = 0, instance_ = 0;
};

}  // namespace treefarm
