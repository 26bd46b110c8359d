#include "worker/geometry/sphere_geometry.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "common/scene/scene.h"

namespace treefarm {
namespace {

/// Outcome of a ray against a sphere: distance in units of the ray's direction, and the unit outward normal.
struct SphereHit {
    double t;
    double normal[3];
};

/// Nearest root in (tnear, tfar].
bool hit_sphere(const Sphere& sphere, const RTCRay& ray, SphereHit& hit) {
    const double o[3] = {double(ray.org_x) - sphere.center.x, double(ray.org_y) - sphere.center.y,
                         double(ray.org_z) - sphere.center.z};
    const double d[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
    const double radius = sphere.radius;
    const double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(dd > 0)) return false;
    const double middle = -(o[0] * d[0] + o[1] * d[1] + o[2] * d[2]) / dd;
    // The discriminant from the ray's closest point to the centre: no difference of large squares.
    double closest2 = 0;
    for (int k = 0; k < 3; ++k) {
        const double c = o[k] + middle * d[k];
        closest2 += c * c;
    }
    const double discriminant = radius * radius - closest2;
    if (!(discriminant >= 0)) return false;
    const double half_chord = std::sqrt(discriminant / dd);
    hit.t = middle - half_chord;
    if (!(hit.t > ray.tnear)) hit.t = middle + half_chord;
    if (!(hit.t > ray.tnear && hit.t <= ray.tfar)) return false;
    for (int k = 0; k < 3; ++k)
        hit.normal[k] = (o[k] + hit.t * d[k]) / radius;
    return true;
}

void bounds(const RTCBoundsFunctionArguments* args) {
    const Sphere& sphere = *static_cast<const Sphere*>(args->geometryUserPtr);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto below = [](float c, float r) { return std::nextafter(std::nextafter(c - r, -kInfinity), -kInfinity); };
    const auto above = [](float c, float r) { return std::nextafter(std::nextafter(c + r, kInfinity), kInfinity); };
    RTCBounds& b = *args->bounds_o;
    b.lower_x = below(sphere.center.x, sphere.radius);
    b.lower_y = below(sphere.center.y, sphere.radius);
    b.lower_z = below(sphere.center.z, sphere.radius);
    b.upper_x = above(sphere.center.x, sphere.radius);
    b.upper_y = above(sphere.center.y, sphere.radius);
    b.upper_z = above(sphere.center.z, sphere.radius);
}

void intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->N != 1 || args->valid[0] == 0) return;
    RTCRayHit& ray_hit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    SphereHit hit;
    if (!hit_sphere(*static_cast<const Sphere*>(args->geometryUserPtr), ray_hit.ray, hit)) return;
    ray_hit.ray.tfar = static_cast<float>(hit.t);
    ray_hit.hit.Ng_x = static_cast<float>(hit.normal[0]);
    ray_hit.hit.Ng_y = static_cast<float>(hit.normal[1]);
    ray_hit.hit.Ng_z = static_cast<float>(hit.normal[2]);
    ray_hit.hit.u = ray_hit.hit.v = 0.0f;
    ray_hit.hit.geomID = args->geomID;
    ray_hit.hit.primID = args->primID;
    ray_hit.hit.instID[0] = args->context->instID[0];
}

void occluded(const RTCOccludedFunctionNArguments* args) {
    if (args->N != 1 || args->valid[0] == 0) return;
    RTCRay& ray = *reinterpret_cast<RTCRay*>(args->ray);
    SphereHit hit;
    if (hit_sphere(*static_cast<const Sphere*>(args->geometryUserPtr), ray, hit))
        ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

void set_sphere_callbacks(RTCGeometry geometry, const Sphere& sphere) {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<Sphere*>(&sphere));
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
}

}  // namespace treefarm
