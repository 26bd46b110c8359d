// SPDX-License-Identifier: Apache-2.0
#include "common/math/warp.h"
#include "tests/oracle/oracle.h"
#include "tests/support/test_scenes.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/emitters.h"
#include "worker/lights/sphere_cone.h"

namespace treefarm::oracle {
namespace {

struct V {
    Quad x, y, z;
    explicit V(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
    V(Quad a, Quad b, Quad c) : x(a), y(b), z(c) {}
    V operator-(const V& o) const { return {x - o.x, y - o.y, z - o.z}; }
    Quad dot(const V& o) const { return x * o.x + y * o.y + z * o.z; }
    V cross(const V& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
};

Vec3 random_point(Inputs& in, float size) {
    return Vec3(in.uniform(-1, 1), in.uniform(-1, 1), in.uniform(-1, 1)) * size;
}

/// Checks samples of a flat light with these half axes or edges, whose area is `share` of their cross product.
template <class Geometry>
void flat_light(Row& row, Inputs& in, const Geometry& geometry, const Vec3& a, const Vec3& b, Quad fraction) {
    Scene scene;
    test::add_shape(scene, geometry, kNone, Rgb(1.0f));
    const EmbreeScene embree(scene.shapes, "avx2");
    const Emitters emitters(scene.emitters, embree, scene.bounds());
    const V normal = V(a).cross(V(b));
    const Quad length = sqrtq(normal.dot(normal));
    const float size = std::max(a.length(), b.length());
    for (int j = 0; j < 64; ++j) {
        const Vec3 p = random_point(in, size * in.scale(0.1f, 1e4f));
        const DirectSample s = emitters.sample_direct(p, {in.bits(), in.bits(), in.bits(), in.bits()});
        if (!(s.pdf > 0.0f)) continue;
        const V d = V(s.on_light.p) - V(p);
        const Quad d2 = d.dot(d), cosine = fabsq(d.dot(normal)) / (length * sqrtq(d2));
        if (cosine < Quad(0.05)) continue;  // its own rounding, over itself
        row.see(relative(s.pdf, d2 / (cosine * length * fraction)), a, b, p);
    }
}

}  // namespace

void lights(std::uint64_t count, std::vector<Row>& rows) {
    Row cone{"sphere: density of the cone, radius 1e-6 to 0.99 of the distance", "relative", 3e-5};
    Row inside{"sphere: sampled directions within the cone (excess of sin^2)", "of the cone's sin^2", 3e-6};
    Row triangle{"triangle: density per steradian, cosines of 0.05 and more", "relative", 1e-4};
    Row disk{"disk: density per steradian, cosines of 0.05 and more", "relative", 1e-4};
    Inputs in(6);
    for (std::uint64_t i = 0; i < count; ++i) {
        const float distance = in.scale(1e-3f, 1e6f);
        const Vec3 center = in.direction() * distance;
        const Sphere sphere{center, distance * in.scale(1e-6f, 0.99f)};
        const SphereCone c = sphere_cone(sphere, Vec3(0.0f));
        if (!c.outside) continue;
        const Quad sin2 = Quad(sphere.radius) * Quad(sphere.radius) / V(center).dot(V(center));
        const Quad exact = 1 / (2 * M_PIq * (sin2 / (1 + sqrtq(1 - sin2))));
        cone.see(relative(c.pdf(), exact), center, sphere.radius);
        const Vec3 local = square_to_cone({in.uniform(0, 1), in.uniform(0, 1)}, c.one_minus_cos);
        const Quad s2 = Quad(local.x) * Quad(local.x) + Quad(local.y) * Quad(local.y);
        inside.see(static_cast<double>(fmaxq(0, s2 / sin2 - 1)), center, sphere.radius);
    }
    for (std::uint64_t i = 0; i < count / 64 + 1; ++i) {
        const float size = in.scale(1e-6f, 1e3f);
        const Vec3 a = in.direction() * size, b = in.direction() * (size * in.scale(1e-2f, 1.0f));
        if (normalize(a).cross(normalize(b)).length() < 0.1f) continue;
        const Vec3 corner = random_point(in, size);
        Mesh mesh;
        mesh.positions = {corner, corner + a, corner + b};
        mesh.indices = {0, 1, 2};
        flat_light(triangle, in, mesh, mesh.positions[1] - corner, mesh.positions[2] - corner, Quad(0.5));
        flat_light(disk, in, Disk{corner, a, b}, a, b, M_PIq);
    }
    rows.insert(rows.end(), {cone, inside, triangle, disk});
}

}  // namespace treefarm::oracle
