// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/surface_detail.h"

#include "common/math/elementary.h"
#include "common/math/frame.h"
#include "worker/geometry/primitive_points.h"

namespace treefarm {
namespace {

constexpr float kTwoPi = 6.28318530717958647693f;

/// Whether two tangents span a plane; false if zero, parallel or not finite.
bool spans_a_plane(const Vec3& a, const Vec3& b) {
    const Imath::V3d u(a), v(b);
    const Imath::V3d n = u.cross(v);
    const double n2 = n.dot(n), u2 = u.dot(u), v2 = v.dot(v);
    return u2 > 0 && v2 > 0 && n2 > 1e-12 * u2 * v2 && std::isfinite(n2);
}

/// Replaces degenerate tangents by a frame around the normal, of length `size`.
void ensure_tangents(SurfaceDetail& detail, const Vec3& normal, float size) {
    if (spans_a_plane(detail.dp_du, detail.dp_dv)) return;
    const Frame frame(normal);
    detail.dp_du = frame.s * size;
    detail.dp_dv = frame.t * size;
}

SurfaceDetail of(const Mesh& mesh, std::uint32_t primitive, float b1, float b2, const Vec3&) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(primitive);
    const Vec3 e1 = mesh.positions[corner[1]] - mesh.positions[corner[0]],
               e2 = mesh.positions[corner[2]] - mesh.positions[corner[0]];
    SurfaceDetail detail;
    if (mesh.uvs.empty()) {
        detail = {{b1, b2}, e1, e2};
    } else {
        const Vec2 uv0 = mesh.uvs[corner[0]], uv1 = mesh.uvs[corner[1]], uv2 = mesh.uvs[corner[2]];
        detail.uv = uv0 * (1.0f - b1 - b2) + uv1 * b1 + uv2 * b2;
        const double du1 = double(uv1.x) - uv0.x, dv1 = double(uv1.y) - uv0.y;
        const double du2 = double(uv2.x) - uv0.x, dv2 = double(uv2.y) - uv0.y;
        const double area = du1 * dv2 - dv1 * du2;
        if (std::abs(area) > 1e-30) {
            const Imath::V3d a(e1), b(e2);
            detail.dp_du = Vec3((a * dv2 - b * dv1) / area);
            detail.dp_dv = Vec3((b * du1 - a * du2) / area);
        }
    }
    ensure_tangents(detail, unit_normal(e1, e2), std::max(e1.length(), e2.length()));
    return detail;
}

SurfaceDetail of(const Sphere& s, std::uint32_t, float, float, const Vec3& n) {
    const Vec3 side = cross(s.pole, s.meridian) * (s.mirrored ? -1.0f : 1.0f);
    const float x = dot(n, s.meridian), y = dot(n, side), z = dot(n, s.pole);
    const float sine = std::sqrt(x * x + y * y);
    SurfaceDetail detail;
    // Angle from the pole by both its sine and cosine: no digits are lost near the poles.
    detail.uv = {azimuth_turn(x, y), 2.0f * azimuth_turn(z, sine)};
    detail.dp_du = (side * x - s.meridian * y) * (kTwoPi * s.radius);
    if (sine > 0.0f) detail.dp_dv = ((s.meridian * x + side * y) * (z / sine) - s.pole * sine) * (kPi * s.radius);
    ensure_tangents(detail, n, s.radius);
    return detail;
}

SurfaceDetail of(const Disk& d, std::uint32_t, float a, float b, const Vec3&) {
    const float r = std::sqrt(a * a + b * b), turn = d.mirrored ? -1.0f : 1.0f;
    SurfaceDetail detail;
    detail.uv = {r, azimuth_turn(a, turn * b)};
    if (r > 0.0f) detail.dp_du = d.half_u * (a / r) + d.half_v * (b / r);
    detail.dp_dv = (d.half_v * a - d.half_u * b) * (turn * kTwoPi);
    ensure_tangents(detail, unit_normal(d.half_u, d.half_v), std::max(d.half_u.length(), d.half_v.length()));
    return detail;
}

SurfaceDetail of(const Cylinder& c, std::uint32_t, float along, float, const Vec3& n) {
    const Vec3 axis = c.p1 - c.p0;
    const Vec3 side = cross(normalize(axis), c.meridian) * (c.mirrored ? -1.0f : 1.0f);
    const float x = dot(n, c.meridian), y = dot(n, side);
    SurfaceDetail detail;
    detail.uv = {azimuth_turn(x, y), along};
    detail.dp_du = (side * x - c.meridian * y) * (kTwoPi * c.radius);
    detail.dp_dv = axis;
    ensure_tangents(detail, n, c.radius);
    return detail;
}

SurfaceDetail of(const Instance&, std::uint32_t, float, float, const Vec3&) {
    return {{0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};  // never hit itself; its members are
}

}  // namespace

SurfaceDetail shape_detail(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward) {
    return std::visit([&](const auto& geometry) { return of(geometry, primitive, b1, b2, outward); }, shape.geometry);
}

Vec2 shape_uv(const Shape& shape, std::uint32_t primitive, float b1, float b2, const Vec3& outward) {
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    if (!mesh) return shape_detail(shape, primitive, b1, b2, outward).uv;
    if (mesh->uvs.empty()) return {b1, b2};
    const std::uint32_t* corner = mesh->indices.data() + 3 * std::size_t(primitive);
    return mesh->uvs[corner[0]] * (1.0f - b1 - b2) + mesh->uvs[corner[1]] * b1 + mesh->uvs[corner[2]] * b2;
}

}  // namespace treefarm
