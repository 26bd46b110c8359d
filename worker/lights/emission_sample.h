// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/base/random.h"
#include "common/math/frame.h"
#include "common/math/warp.h"
#include "worker/geometry/hit.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// Ball around all surfaces, through which light from infinity enters.
struct SceneBall {
    Vec3 center{0.0f};
    float radius = 0;  ///< 0: there are no surfaces to light

    SceneBall() = default;
    /// Slightly larger than the box's ball, so that rounding leaves no corner outside.
    explicit SceneBall(const Box3& box) {
        if (box.isEmpty()) return;
        const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
        center = Vec3((Imath::V3d(box.max) + Imath::V3d(box.min)) * 0.5);
        radius = static_cast<float>(0.5 * std::sqrt(size.dot(size)) * (1.0 + 0x1p-16));
    }

    /// Cross-section area.
    float section() const { return kPi * radius * radius; }
};

/// Kind of a light path's start.
enum class EmissionFrom : std::uint8_t {
    nothing,
    surface,      ///< an area emitter
    point,        ///< a point, spot or projector
    parallel,     ///< directional light
    environment,  ///< light from infinity in many directions
};

/// A ray that leaves an emitter, with the densities of position and direction (docs/design/transport.md).
struct EmissionSample {
    EmissionFrom from = EmissionFrom::nothing;
    Ray ray{Vec3(0.0f), Vec3(0.0f)};  ///< direction of length 1
    Rgb weight{0.0f};    ///< emitted radiance or intensity, times the cosine, over all densities; its mean is the power
    Rgb radiance{0.0f};  ///< of an area emitter: radiance that leaves the point, in every direction of its front
    Hit start;           ///< of an area emitter; of a point only its position
    std::uint32_t entry = 0;        ///< entry of EmissionChoice
    std::uint32_t delta_light = 0;  ///< index of an emitter without extent among those
    /// Density of the start, with the probability of the emitter. Surfaces: per area; environment: of the direction
    /// that light comes from, per steradian; otherwise a probability.
    float position_pdf = 0;
    /// Per steradian; for light from infinity: density of the position across the direction, per area.
    float direction_pdf = 0;

    bool from_infinity() const { return from == EmissionFrom::parallel || from == EmissionFrom::environment; }
    /// Whether no scattered ray can find its start.
    bool is_delta() const { return from == EmissionFrom::point || from == EmissionFrom::parallel; }

    /// Density per area with which the ray hits a surface of normal `ng` at `p`.
    double next_pdf(const Vec3& p, const Vec3& ng) const {
        const double cosine = std::abs(double(dot(ng, ray.direction)));
        return double(direction_pdf) * cosine / (from_infinity() ? 1.0 : distance2(p));
    }
    /// Factor from a density per steradian at the next vertex `p` to one in the measure of position_pdf; 0 if only
    /// emitter sampling finds the start.
    double position_factor(const Vec3& p) const {
        if (is_delta()) return 0.0;
        return from_infinity() ? 1.0 : std::abs(double(dot(start.ng, ray.direction))) / distance2(p);
    }

  private:
    double distance2(const Vec3& p) const {
        const Imath::V3d d = Imath::V3d(p) - Imath::V3d(start.p);
        return d.dot(d);
    }
};

/// Densities of a ray that leaves an emitter, as in EmissionSample.
struct EmissionDensity {
    float position = 0, direction = 0;
};

/// Ray from a point of this intensity (W / sr) in a direction drawn with density `pdf`.
inline EmissionSample emitted_from_point(const Vec3& position, const Vec3& direction, const Rgb& intensity, float pdf) {
    EmissionSample sample;
    sample.from = EmissionFrom::point;
    sample.ray = {position, direction};
    sample.weight = intensity * (1.0f / pdf);
    sample.start.p = position;
    sample.position_pdf = 1.0f;
    sample.direction_pdf = pdf;
    return sample;
}

/// Ray of light from infinity along a direction, uniform across the scene's ball. `irradiance`: on a surface that faces
/// it.
inline EmissionSample emitted_across(const SceneBall& ball, const Vec3& direction, const Rgb& irradiance, const Vec2& u,
                                     EmissionFrom from) {
    const Vec2 disk = square_to_disk(u);
    const Frame frame(direction);
    EmissionSample sample;
    sample.from = from;
    sample.ray = {ball.center + (frame.s * disk.x + frame.t * disk.y - direction) * ball.radius, direction};
    sample.weight = irradiance * ball.section();
    sample.position_pdf = 1.0f;
    sample.direction_pdf = 1.0f / ball.section();
    return sample;
}

}  // namespace treefarm
