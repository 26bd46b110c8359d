#pragma once

struct RTCGeometryTy;

namespace treefarm {

struct Sphere;

/// Makes an Embree user geometry answer for `sphere`, which must outlive it. Intersection is solved in double: a float
/// quadratic loses the sphere that is small and far away, or whose surface the ray starts on.
void set_sphere_callbacks(RTCGeometryTy* geometry, const Sphere& sphere);

}  // namespace treefarm
