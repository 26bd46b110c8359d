// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <quadmath.h>

#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace treefarm::oracle {

/// 113 bits: g++'s libquadmath.
__extension__ using Quad = __float128;

/// How far a function of ours is from its definition, evaluated with 113 bits for exactly the same floats.
struct Row {
    std::string what;
    std::string measure;  ///< what the error is relative to
    double bound;         ///< that the worst error keeps
    std::uint64_t inputs = 0;
    double worst = 0;
    std::string worst_input{};

    template <class... Parts>
    void see(double error, const Parts&... parts) {
        ++inputs;
        if (error <= worst) return;  // NaN is worse than all
        worst = error;
        std::ostringstream text;
        text.precision(9);
        ((text << parts << ' '), ...);
        worst_input = text.str();
        worst_input.pop_back();
    }
};

inline double relative(float ours, Quad exact) {
    return static_cast<double>(fabsq((Quad(ours) - exact) / exact));
}

inline double absolute(float ours, Quad exact) {
    return static_cast<double>(fabsq(Quad(ours) - exact));
}

/// Random numbers of the adversarial kind.
class Inputs {
  public:
    explicit Inputs(unsigned seed) : engine_(seed) {}

    float uniform(float low, float high) { return low + (high - low) * unit_(engine_); }
    /// Evenly in the logarithm.
    float scale(float low, float high) { return low * std::pow(high / low, unit_(engine_)); }
    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
    bool chance(float p) { return unit_(engine_) < p; }
    /// A unit vector; a third of them are within 1e-8 to 1 of an axis, edge or pole.
    Vec3 direction() {
        Vec3 d(normal_(engine_), normal_(engine_), normal_(engine_));
        if (chance(0.33f))
            for (int axis = 0; axis < 3; ++axis)
                if (chance(0.5f)) d[axis] *= scale(1e-8f, 1.0f);
        return normalize(d);
    }
    /// A direction above the horizon, as adverse as direction().
    Vec3 hemisphere() {
        Vec3 d = direction();
        d.z = std::max(std::abs(d.z), 1e-30f);
        return d;
    }

  private:
    std::mt19937 engine_;
    std::uniform_real_distribution<float> unit_;
    std::normal_distribution<float> normal_;
};

/// Rows of the comparison by subject; each function compares `count` inputs per row.
void microfacets(std::uint64_t count, std::vector<Row>& rows);
void boundaries(std::uint64_t count, std::vector<Row>& rows);
void directions(std::uint64_t count, std::vector<Row>& rows);
void lights(std::uint64_t count, std::vector<Row>& rows);
void quadtrees(std::uint64_t count, std::vector<Row>& rows);

std::vector<Row> all(std::uint64_t count);

}  // namespace treefarm::oracle
