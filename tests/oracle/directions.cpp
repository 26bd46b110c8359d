// SPDX-License-Identifier: Apache-2.0
#include "common/math/direction_map.h"
#include "common/math/frame.h"
#include "tests/oracle/oracle.h"

namespace treefarm::oracle {
namespace {

struct Square {
    Quad x, y;
};

/// Clarberg 2008, of a direction that is not quite unit, as our map takes it.
Square exact_square(const Vec3& d) {
    const Quad x = fabsq(Quad(d.x)), y = fabsq(Quad(d.y)), z = fabsq(Quad(d.z));
    const Quad length = sqrtq(x * x + y * y + z * z);
    const Quad r = sqrtq(1 - z / length), phi = atan2q(y, x) * 2 / M_PIq;
    Quad v = phi * r, u = r - v;
    if (d.z < 0) {
        const Quad t = u;
        u = 1 - v;
        v = 1 - t;
    }
    return {(copysignq(u, Quad(d.x)) + 1) / 2, (copysignq(v, Quad(d.y)) + 1) / 2};
}

Quad dot_of(const Vec3& a, const Vec3& b) {
    return Quad(a.x) * Quad(b.x) + Quad(a.y) * Quad(b.y) + Quad(a.z) * Quad(b.z);
}

}  // namespace

void directions(std::uint64_t count, std::vector<Row>& rows) {
    Row axes{"frame: axes unit and at right angles", "absolute", 5e-7};
    Row to{"direction to square", "absolute, in the square", 4e-7};
    Row from{"square to direction: unit", "absolute", 5e-7};
    Row back{"square to direction and back", "absolute, in the square", 5e-7};
    Row turn{"sine and cosine of a turn", "absolute", 4e-7};
    Inputs in(5);
    for (std::uint64_t i = 0; i < count; ++i) {
        Vec3 d = in.direction();
        const Frame f(d);
        const Quad off = fabsq(dot_of(d, d) - 1);  // of the normal itself
        for (const Quad error :
             {dot_of(f.s, f.s) - 1, dot_of(f.t, f.t) - 1, dot_of(f.s, f.t), dot_of(f.s, d), dot_of(f.t, d)})
            axes.see(static_cast<double>(fmaxq(0, fabsq(error) - off)), d);
        const Vec2 p = direction_to_square(d);
        const Square exact = exact_square(d);
        // Close to the equator's fold both sides of it are right.
        const double error = std::max(absolute(p.x, exact.x), absolute(p.y, exact.y));
        if (std::abs(d.z) > 1e-6f && std::abs(d.x) > 1e-6f && std::abs(d.y) > 1e-6f) to.see(error, d);
        const Vec2 q(in.uniform(0.0f, 1.0f), in.chance(0.3f) ? in.scale(1e-8f, 1.0f) : in.uniform(0.0f, 1.0f));
        const Vec3 w = square_to_direction(q);
        from.see(static_cast<double>(fabsq(dot_of(w, w) - 1)), q);
        const Square again = exact_square(w);
        if (std::abs(w.z) > 1e-3f && std::abs(w.x) > 1e-6f && std::abs(w.y) > 1e-6f)
            back.see(std::max(absolute(q.x, again.x), absolute(q.y, again.y)), q);
        const float u = in.uniform(0.0f, 1.0f);
        const SinCos s = sincos_turn(u);
        turn.see(std::max(absolute(s.sin, sinq(2 * M_PIq * Quad(u))), absolute(s.cos, cosq(2 * M_PIq * Quad(u)))), u);
    }
    rows.insert(rows.end(), {axes, to, from, back, turn});
}

}  // namespace treefarm::oracle
