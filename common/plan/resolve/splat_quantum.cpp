// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/splat_quantum.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "common/film/splat_film.h"
#include "common/scene/kinds/shape_area.h"

namespace treefarm {
namespace {

/// Quantum over the expected size of a splat.
constexpr double kFiner = 0x1p-20;
/// Quanta in the value that splat_exponent() expects.
constexpr double kOfExponent = 0x1p10;
/// Least squared distance of a lamp from the lens, relative to the scene's. Nearer distances than the scene's count
/// only if the light is then more than kAlike times as bright.
constexpr double kNearest = 0x1p-16, kAlike = 16.0;

/// Camera importance at the middle of the film, per area facing the camera at this distance.
double importance(const Camera& camera, double distance2) {
    if (camera.panoramic) return 1 / (2 * M_PI * M_PI * distance2);
    const Imath::V3d middle = Imath::V3d(camera.corner) + (Imath::V3d(camera.across) + Imath::V3d(camera.down)) * 0.5;
    const Imath::V3d n = Imath::V3d(camera.across).cross(Imath::V3d(camera.down));
    if (camera.is_orthographic()) return 1 / std::abs(n.dot(Imath::V3d(camera.parallel)));
    const double length2 = middle.dot(middle);
    return length2 * std::sqrt(length2) / std::abs(middle.dot(n)) / distance2;
}

/// Squared distance from the lens at which an emitter's light is seen. Light falls near its lamp, so this is the
/// lamp's distance, limited to between `nearest` times the scene's and the scene's.
double seen_from(const Scene& scene, const Box3& lamp, double distance2, double nearest) {
    if (lamp.isEmpty()) return distance2;
    const Imath::V3d half = (Imath::V3d(lamp.max) - Imath::V3d(lamp.min)) * 0.5;
    const Imath::V3d to_lamp = Imath::V3d(lamp.min) + half - Imath::V3d(scene.camera.origin);
    return std::clamp(to_lamp.dot(to_lamp) + half.dot(half), nearest * distance2, distance2);
}

/// Power in watts, as a mean of the channels, that the emitters send into a ball of radius R around the surfaces,
/// each times the camera's importance at the distance from which it is seen.
double power_seen(const Scene& scene, double radius2, double distance2, double nearest) {
    const LitScene lit{static_cast<float>(radius2), scene.images};
    double sum = 0;
    for (const Emitter& emitter : scene.emitters)
        std::visit(
            [&]<class Kind>(const Kind& kind) {
                const auto scale = double(kind.radiance_scale(lit));
                Box3 lamp;
                double power = 0;
                if constexpr (Kind::kTraits.type == LightType::area) {
                    if (kind.shape == kNone) return;
                    const Shape& shape = scene.shapes[static_cast<std::size_t>(kind.shape)];
                    power = M_PI * scale * area_of(shape.geometry);
                    lamp = own_box(shape);
                } else if constexpr (Kind::kTraits.type == LightType::delta) {
                    const auto cone = kind.cone();
                    power = (cone ? 4 * M_PI : M_PI) * scale * radius2;  // intensity of a point, or parallel light
                    if (cone) lamp.extendBy(cone->apex);
                } else {
                    power = M_PI * M_PI * scale * radius2;
                }
                sum += power * importance(scene.camera, seen_from(scene, lamp, distance2, nearest));
            },
            emitter.kind);
    return sum;
}

}  // namespace

std::int16_t usual_splat_exponent(const Scene& scene) {
    const Box3 box = scene.bounds();
    if (box.isEmpty()) return 0;
    const Imath::V3d half = (Imath::V3d(box.max) - Imath::V3d(box.min)) * 0.5;
    const double radius2 = std::max(half.dot(half), 1e-30);
    const Imath::V3d to_scene = Imath::V3d(box.min) + half - Imath::V3d(scene.camera.origin);
    const double distance2 = std::max(to_scene.dot(to_scene), radius2);
    const double per_window = double(scene.film.whole_width()) * double(scene.film.whole_height()) /
                              static_cast<double>(scene.film.pixel_count());
    // A lamp at the lens may light far surfaces, so a very small distance is not trusted. A coarser quantum is needed
    // only where splats would come near their cap, 2^30 times the usual one; the margin up to it is for rare paths.
    const double power =
        std::max(power_seen(scene, radius2, distance2, 1.0), power_seen(scene, radius2, distance2, kNearest) / kAlike);
    const double splat = power / (2 * M_PI) * per_window;
    return splat_exponent(splat * kFiner * kOfExponent);
}

}  // namespace treefarm
