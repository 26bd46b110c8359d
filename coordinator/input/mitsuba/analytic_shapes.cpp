// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "coordinator/input/mitsuba/shapes.h"

namespace treefarm::mitsuba {
namespace {

using Vec3d = Imath::V3d;

/// Image of a direction in double precision.
Vec3d image(const Matrix& m, const Vec3d& v) {
    Vec3d result;
    m.multDirMatrix(v, result);
    return result;
}

struct Frame {
    Vec3d s, t, n;
};

/// Frame around a direction, whose s is the start of Mitsuba's azimuth. Version 0: coordinateSystem() in util.cpp;
/// versions 2 and 3: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
Frame frame_about(const Vec3d& n, int version) {
    if (version < 2) {
        const bool by_x = std::abs(n.x) > std::abs(n.y);
        const Vec3d t = (by_x ? Vec3d(n.z, 0.0, -n.x) : Vec3d(0.0, n.z, -n.y)).normalized();
        return {t.cross(n), t, n};
    }
    const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    return {Vec3d(sign * n.x * n.x * a + 1.0, sign * b, -sign * n.x), Vec3d(b, sign + n.y * n.y * a, -n.y), n};
}

Vec3 unit(const Vec3d& v) {
    return Vec3(v.normalized());
}

}  // namespace

Sphere read_sphere(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    const double scale = uniform_scale(to_world);
    if (!(scale > 0.0))
        throw InputError(properties.where("to_world"), "the sphere's transformation scales axes differently or shears",
                         "an ellipsoid is not available in this version: scale all axes alike");
    Sphere sphere;
    const Vec3 center = properties.point("center", Vec3(0.0f));
    sphere.radius = static_cast<float>(properties.positive("radius", 1.0) * scale);
    sphere.flip_normals = properties.boolean("flip_normals", false);
    sphere.pole = unit(image(to_world, {0, 0, 1}));
    sphere.meridian = unit(image(to_world, {1, 0, 0}));
    sphere.mirrored = is_mirroring(to_world);
    if (properties.element().version >= 2) {
        sphere.center = transform_point(to_world, center);
        if (sphere.mirrored) sphere.flip_normals = !sphere.flip_normals;
    } else {
        // Mitsuba 0.6 removes the scale from the transformation before it moves the centre.
        sphere.center = transform_point(to_world, center * static_cast<float>(1.0 / scale));
    }
    return sphere;
}

Disk read_disk(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    Disk disk;
    disk.center = transform_point(to_world, Vec3(0.0f));
    disk.half_u = Vec3(image(to_world, {1, 0, 0}));
    disk.half_v = Vec3(image(to_world, {0, 1, 0}));
    // The front is where the image of +z is, as for all normals; flipping scales z by -1.
    disk.mirrored = is_mirroring(to_world) != properties.boolean("flip_normals", false);
    if (disk.mirrored) disk.half_v = -disk.half_v;
    return disk;
}

Cylinder read_cylinder(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    const int version = properties.element().version;
    const Vec3d p0(properties.point("p0", Vec3(0.0f))), p1(properties.point("p1", Vec3(0.0f, 0.0f, 1.0f)));
    const double radius = properties.positive("radius", 1.0);
    if (!((p1 - p0).length() > 0.0))
        throw InputError(properties.where("p1"), "the cylinder's ends p0 and p1 are the same point", "move them apart");
    const Frame frame = frame_about((p1 - p0).normalized(), version);
    const Vec3d s = image(to_world, frame.s), t = image(to_world, frame.t), n = image(to_world, frame.n);
    const bool is_round = std::abs(s.length() / t.length() - 1.0) < 1e-3 && std::abs(s.dot(t)) < 1e-3 * s.dot(s) &&
                          std::abs(s.dot(n)) < 1e-3 * s.length() * n.length() &&
                          std::abs(t.dot(n)) < 1e-3 * t.length() * n.length();
    if (!is_round)
        throw InputError(properties.where("to_world"),
                         "the cylinder's transformation shears it or makes it an ellipse across its axis",
                         "scale both directions across the axis alike");
    Cylinder cylinder;
    cylinder.p0 = transform_point(to_world, Vec3(p0));
    cylinder.p1 = transform_point(to_world, Vec3(p1));
    cylinder.radius = static_cast<float>(radius * s.length());
    cylinder.meridian = unit(s - n * (s.dot(n) / n.dot(n)));
    cylinder.mirrored = is_mirroring(to_world);
    cylinder.flip_normals = properties.boolean("flip_normals", false);
    // The normal is the product of the tangents, so a mirror turns it inwards; versions 2 and 3 turn it back.
    if (version < 2 && cylinder.mirrored) cylinder.flip_normals = !cylinder.flip_normals;
    return cylinder;
}

}  // namespace treefarm::mitsuba
