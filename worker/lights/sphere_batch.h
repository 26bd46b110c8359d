// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>

#include "common/base/random_batch.h"
#include "common/math/warp_batch.h"
#include "worker/lights/sphere_sample.h"

namespace treefarm {

/// Points on spherical emitters to be drawn together, each from its own point, by vector code. Each equals, to the bit,
/// the result of kSample alone.
template <SphereSample (*kSample)(const Vec3& center, float radius, const Vec3& from, const Vec2& u)>
class SphereBatch {
  public:
    static constexpr std::uint32_t kMost = kDrawBatch;

    void clear() { count_ = 0; }

    /// Adds a sphere with its random numbers; returns its index.
    std::uint32_t add(const Sphere& sphere, const Vec3& from, const Draw& random) {
        assert(count_ < kMost);
        cx_[count_] = sphere.center.x;
        cy_[count_] = sphere.center.y;
        cz_[count_] = sphere.center.z;
        radius_[count_] = sphere.radius;
        fx_[count_] = from.x;
        fy_[count_] = from.y;
        fz_[count_] = from.z;
        u_bits_[count_] = random[2];
        v_bits_[count_] = random[3];
        return count_++;
    }

    void draw() {
        for (std::uint32_t i = 0; i < whole_lanes(count_); ++i) {
            const SphereSample s = kSample({cx_[i], cy_[i], cz_[i]}, radius_[i], {fx_[i], fy_[i], fz_[i]},
                                           {to_unit(u_bits_[i]), to_unit(v_bits_[i])});
            dx_[i] = s.direction.x;
            dy_[i] = s.direction.y;
            dz_[i] = s.direction.z;
            nx_[i] = s.normal.x;
            ny_[i] = s.normal.y;
            nz_[i] = s.normal.z;
            px_[i] = s.p.x;
            py_[i] = s.p.y;
            pz_[i] = s.p.z;
            distance_[i] = s.distance;
            pdf_[i] = s.pdf;
        }
    }

    SphereSample operator[](std::uint32_t i) const {
        return {{dx_[i], dy_[i], dz_[i]}, {nx_[i], ny_[i], nz_[i]}, {px_[i], py_[i], pz_[i]}, distance_[i], pdf_[i]};
    }

  private:
    using Lanes = std::array<float, kMost>;

    std::uint32_t count_ = 0;
    // Zero-initialised, since vector code runs beyond the last lane.
    alignas(64) Lanes cx_{}, cy_{}, cz_{}, radius_{}, fx_{}, fy_{}, fz_{};
    std::array<std::uint32_t, kMost> u_bits_{}, v_bits_{};
    Lanes dx_, dy_, dz_, nx_, ny_, nz_, px_, py_, pz_, distance_, pdf_;
};

}  // namespace treefarm
