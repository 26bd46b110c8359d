// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/first_hit/first_hit.h"

#include <algorithm>
#include <cmath>

#include "common/film/radiance_limit.h"
#include "worker/integrators/sample_loop.h"
#include "worker/integrators/subpath/surface_light.h"

namespace treefarm {

namespace {

/// Number of directions for the albedo of a surface that is not plainly diffuse; the same directions each time, so that
/// the layer has no noise.
constexpr std::uint32_t kAlbedoSamples = 8;

/// Point i of a lattice in which each coordinate takes kAlbedoSamples evenly spaced values. One of them is in the outer
/// eighth of the disk that the last two coordinates are mapped to, where a rough surface loses most of its light.
BsdfRandom albedo_point(std::uint32_t i) {
    const auto coordinate = [&](std::uint32_t step, float offset) {
        return (static_cast<float>(i * step % kAlbedoSamples) + offset) / kAlbedoSamples;
    };
    return {coordinate(1, 0.5f), {coordinate(3, 0.875f), coordinate(5, 0.5f)}};
}

/// Albedo towards wo under uniform illumination, delta lobes included.
template <class Surface>
Rgb albedo_of(const Surface& surface) {
    if (surface.black()) return Rgb(0.0f);
    bool diffuse = true;
    if constexpr (Surface::kGeneral) diffuse = std::holds_alternative<DiffuseBsdf>(surface.bsdf().kind);
    const std::uint32_t count = diffuse ? 1 : kAlbedoSamples;
    Rgb sum(0.0f);
    for (std::uint32_t i = 0; i < count; ++i) {
        const BsdfSample s = surface.bsdf().sample(surface.wo(), albedo_point(i));
        if (!(s.pdf > 0.0f)) continue;
        float back = 1.0f;  // scaling of refracted radiance is undone: it is no property of the material
        if constexpr (Surface::kGeneral)
            if (s.wi.z < 0.0f) back = surface.eta2();
        sum += s.f_cos * (back / s.pdf);
    }
    Rgb albedo = sum * (1.0f / static_cast<float>(count));
    for (int c = 0; c < 3; ++c)
        albedo[c] = albedo[c] > 0.0f ? std::min(albedo[c], 1.0f) : 0.0f;
    return albedo;
}

/// Whether the surface is a null boundary: light passes straight on.
template <class Surface>
bool is_nothing(const Surface& surface) {
    if constexpr (Surface::kGeneral)
        return !surface.black() && std::holds_alternative<NullBsdf>(surface.bsdf().kind);
    else
        return false;
}

/// The value, or 0 for one that no layer can hold.
double finite(float value) {
    return std::abs(value) <= kMostRadiance ? static_cast<double>(value) : 0.0;
}

/// AOV values of a sample, to which contributions are added.
class Row {
  public:
    Row(const AovLayout& layout, double* values) : layout_(layout), values_(values) {}

    void add(Aov aov, float value) {
        if (layout_.has(aov)) values_[layout_.at(aov)] += finite(value);
    }
    void add(Aov aov, const Vec3& v) {
        if (!layout_.has(aov)) return;
        for (int c = 0; c < 3; ++c)
            values_[layout_.at(aov) + static_cast<std::uint32_t>(c)] += finite(v[c]);
    }
    void add(Aov aov, const Vec2& v) {
        if (!layout_.has(aov)) return;
        values_[layout_.at(aov)] += finite(v.x);
        values_[layout_.at(aov) + 1] += finite(v.y);
    }
    void set(Aov aov, std::int64_t id) {
        if (layout_.has(aov)) values_[layout_.at(aov)] = static_cast<double>(id);
    }

  private:
    const AovLayout& layout_;
    double* values_;
};

/// Tracer of one camera ray to its AOV surface.
template <class Surface>
class Follower {
  public:
    Follower(const TraceScene& scene, const AovLayout& layout, const Vec3& eye, const Vec3& axis)
        : scene_(scene), layout_(layout), eye_(eye), axis_(axis), scratch_(Surface::make_scratch(scene)) {}

    /// Traces a sample's ray; `first`: the pixel's first sample, whose ids are stored.
    void follow(const Numbers auto& numbers, Ray ray, bool first, double* values) {
        Row row(layout_, values);
        const bool beyond = layout_.has(Aov::albedo) || layout_.has(Aov::normal);
        const Vec3 from = ray.origin;
        bool seen = false;
        for (std::uint32_t vertex = 1; vertex <= kMostSmoothSurfaces; ++vertex) {
            Hit hit;
            if (!scene_.geometry().intersect(ray, hit)) return;
            scene_.geometry().keep_inside(hit, ray);
            const Surface surface(scene_, hit, -ray.direction, scratch_);
            if (!seen && !is_nothing(surface)) {
                seen = true;
                take(hit, ray, from, first, row);
            }
            if (!beyond && seen) return;
            if (!surface.has_delta() || surface.smooth() || surface.black()) {
                row.add(Aov::normal, towards(surface.bent_normal(), ray));
                if (layout_.has(Aov::albedo)) row.add(Aov::albedo, flat_albedo(hit, surface, ray));
                return;
            }
            const BsdfSample s = sample_bsdf(surface, draw(numbers, vertex, Stream::scatter));
            if (!(s.pdf > 0.0f)) return;
            const Vec3 direction = surface.frame().to_world(s.wi);
            ray = {offset_origin(hit, direction), direction};
        }
    }

  private:
    static Vec3 towards(const Vec3& normal, const Ray& ray) {
        return dot(normal, ray.direction) > 0.0f ? -normal : normal;
    }

    /// Albedo without bump and normal maps, whose detail the normal has: a tilted surface loses light that would go
    /// below the real one. Replaces the surface's BSDF in the scratch.
    Rgb flat_albedo(const Hit& hit, const Surface& surface, const Ray& ray) {
        if constexpr (Surface::kGeneral)
            return albedo_of(Surface(scene_, hit, -ray.direction, scratch_, true));
        else
            return albedo_of(surface);
    }

    /// Records the first surface of the camera ray.
    void take(const Hit& hit, const Ray& ray, const Vec3& from, bool first, Row& row) {
        row.add(Aov::alpha, 1.0f);
        row.add(Aov::geometric_normal, towards(hit.ng, ray));
        row.add(Aov::depth, axis_ == Vec3(0.0f) ? (hit.p - eye_).length() : dot(hit.p - eye_, axis_));
        row.add(Aov::distance, (hit.p - from).length());
        row.add(Aov::position, hit.p);
        if (layout_.has(Aov::uv)) row.add(Aov::uv, scene_.geometry().uv(hit));
        if (!first) return;
        row.set(Aov::shape, hit.instance != 0 ? std::int64_t{hit.instance} : std::int64_t{hit.shape} + 1);
        row.set(Aov::material, std::int64_t{scene_.geometry().shape(hit.shape).material} + 1);
    }

    const TraceScene& scene_;
    const AovLayout& layout_;
    Vec3 eye_, axis_;
    typename Surface::Scratch scratch_;
};

}  // namespace

Vec3 camera_axis(const Camera& camera) {
    if (camera.panoramic) return Vec3(0.0f);
    const Vec3 normal = cross(camera.across, camera.down);
    const Vec3 ahead = camera.is_orthographic() ? camera.parallel : camera.corner;
    const float side = dot(normal, ahead);
    const float length = normal.length();
    if (!(length > 0.0f) || side == 0.0f) return normalize(ahead);
    return normal * ((side < 0.0f ? -1.0f : 1.0f) / length);
}

FirstHitRenderer::FirstHitRenderer(std::shared_ptr<const TraceScene> scene, const Camera& camera, std::uint64_t seed,
                                   const AovLayout& layout)
    : scene_(std::move(scene)), seed_(seed), layout_(layout), eye_(camera.origin), axis_(camera_axis(camera)) {}

template <class Surface>
void FirstHitRenderer::render_unit(const PassPlan& pass, const WorkUnit& unit, AovPixels& output) const {
    const std::size_t row = layout_.size();
    Follower<Surface> follower(*scene_, layout_, eye_, axis_);
    std::vector<double> blocks;
    for (UnitCursor at(pass, unit); !at.done();) {
        if (at.sample % kBlockSamples == 0) blocks.resize(blocks.size() + row);
        const PathKey key{seed_, scene_->film().key_of(at.x, at.y), pass.first_sample + at.sample};
        follower.follow(key, scene_->camera().generate(at.x, at.y, key), at.sample == 0, &blocks[blocks.size() - row]);
        if (!at.advance()) continue;
        reduce_aov_blocks(layout_, blocks);
        output.values.insert(output.values.end(), blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(row));
        blocks.clear();
    }
}

void FirstHitRenderer::render(const PassPlan& pass, const WorkUnit& unit, AovPixels& output) const {
    if (layout_.size() == 0) return;
    output.values.reserve(layout_.size() * std::size_t{unit.pixel_count()});
    with_surface(*scene_, [&]<class Surface>() { render_unit<Surface>(pass, unit, output); });
}

}  // namespace treefarm
