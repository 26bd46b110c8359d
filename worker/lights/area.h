// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/base/random.h"
#include "common/scene/kinds/emitters/area.h"
#include "worker/geometry/embree_scene.h"
#include "worker/geometry/primitive_points.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/area_patches.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/light_bounds.h"
#include "worker/lights/sphere_sample.h"

namespace treefarm {

/// Whether a direction is on the front side of a surface; true if `front` is nullptr.
inline bool sees(const Vec3* front, const Vec3& direction) {
    return !front || dot(*front, direction) > 0.0f;
}

/// Scene data of area lights.
struct LightScene {
    const EmbreeScene* geometry;
    const TextureSet* textures;  ///< nullptr: the scene has no textures
};

/// An emitting shape with the probabilities of its triangles. Disks and cylinders count as one triangle. `front`:
/// normal of a surface at p that only reflects (Emitters::sample_direct).
struct AreaLight {
    /// A colour returned in registers: the rare textured case does not force the frequent one through memory.
    struct Channels {
        float r, g, b;
        Rgb rgb() const { return {r, g, b}; }
    };

    Rgb radiance{0.0f};  ///< radiance, or the factor on its texture
    std::int32_t texture = kNone;
    std::uint32_t shape = 0;
    const Sphere* sphere = nullptr;
    bool plain = false;               ///< a mesh without texture or mask
    float selection = 0;              ///< probability of this light in the choice by power
    DiscreteTable triangles;          ///< meshes
    AreaPatches patches;              ///< of next event; uncut unless cut() was called
    std::vector<float> area_density;  ///< per triangle: density per area within this light; empty for spheres
    std::vector<FlatTriangle> flat;   ///< of a plain small mesh without shading normals
    const Mask* mask = nullptr;
    /// Whether a sphere is sampled by its cone from outside. False if it shines inwards and a mask lets its light out.
    bool by_cone = false;

    /// Throws RunError if the emitter has a texture and the scene has none.
    AreaLight(const AreaEmitter& emitter, const LightScene& scene);

    /// Mean radiance over the surface, without masks.
    Rgb mean_radiance(const LightScene& scene) const;
    /// Power in watts, mean of the channels.
    double power(const LightScene& scene) const;

    /// Cuts a mesh into patches, if it is large enough to gain by it.
    void cut(const LightScene& scene, float least_extent);
    /// Number of patches that next event chooses among; 1 if uncut.
    std::uint32_t patch_count() const { return std::max(patches.count(), 1u); }
    /// Fraction of the light's power in a patch.
    double share(std::uint32_t patch) const { return patches.count() > 0 ? patches.share(patch) : 1.0; }
    /// Patch of a hit.
    std::uint32_t patch_of(const Hit& hit) const { return patches.count() > 0 ? patches.patch_of(hit.primitive) : 0; }
    /// Bounds of a patch: position, directions and amount of its light.
    LightBounds bounds(const LightScene& scene, std::uint32_t patch) const;

    /// Emitted radiance at a hit of a textured light.
    Channels textured(const LightScene& scene, const Hit& hit) const;

    /// Samples a point of a patch, as if it were the only light. random[1] chooses the triangle, [2] and [3] the point.
    DirectSample sample(const LightScene& scene, std::uint32_t patch, const Vec3& p, const Draw& random,
                        const Vec3* front) const {
        if (sphere) return sample_sphere(scene, p, random, front);
        DirectSample sample = sample_flat(scene, patch, p, random, front);
        shine(scene, sample);
        return sample;
    }

    /// Samples a point of a mesh; the radiance is without texture and mask.
    DirectSample sample_mesh(const LightScene& scene, std::uint32_t patch, const Vec3& p, const Draw& random,
                             const Vec3* front) const {
        const std::uint32_t triangle = patches.count() > 0 ? patches.pick(patch, random[1]) : triangles.pick(random[1]);
        const Vec2 b = square_to_triangle({to_unit(random[2]), to_unit(random[3])});
        DirectSample sample;
        Hit& hit = sample.on_light;
        if (flat.empty()) {
            scene.geometry->set_triangle_point(hit, shape, triangle, b.x, b.y);
        } else {
            hit.shape = shape;
            hit.primitive = triangle;
            flat[triangle].set_point(hit, b.x, b.y);
        }
        if (front && !(dot(*front, hit.p - p) > 0.0f && dot(hit.ng, p - hit.p) > 0.0f)) return sample;
        look_at(sample, p, radiance, next_event_density()[triangle]);
        return sample;
    }

    /// Sample from a point drawn on the sphere.
    DirectSample on_sphere(const LightScene& scene, const SphereSample& drawn, bool from_cone,
                           const Vec3* front) const {
        DirectSample sample;
        if (!(drawn.pdf > 0.0f) || !sees(front, drawn.direction)) return sample;
        sample.wi = drawn.direction;
        sample.on_light = sphere_hit(*sphere, drawn.p, drawn.normal);
        sample.on_light.shape = shape;
        sample.distance = drawn.distance;
        sample.pdf = drawn.pdf;
        // A ray within the cone hits the outside first, even if rounding puts the point beyond the rim.
        const bool shines = from_cone ? !sphere->flip_normals : dot(sample.on_light.ng, drawn.direction) < 0.0f;
        if (shines) sample.radiance = radiance;
        shine(scene, sample);
        return sample;
    }

    /// Density per steradian of sample() for a hit from p along wi; `chosen`: probability of choosing its patch.
    float pdf(const Vec3& p, const Vec3& wi, const Hit& hit, float chosen) const {
        float density;
        if (sphere) {
            const SphereCone cone = sphere_cone(*sphere, p);
            if (cone.outside && by_cone) return chosen * cone.pdf();
            density = sphere_area_density(sphere->radius);
        } else {
            density = next_event_density()[hit.primitive];
        }
        const Vec3 to_light = hit.p - p;
        return chosen * per_steradian(density, dot(to_light, to_light), std::abs(dot(hit.ng, wi)));
    }

    /// Point distributed uniformly by area, for any shape: random[1] chooses the triangle, [2] and [3] the point.
    /// `density` is set to the density per area within this light.
    Hit point(const LightScene& scene, const Draw& random, float& density) const;
    /// Radiance that leaves a point on its front, times its mask's opacity.
    Rgb radiance_at(const LightScene& scene, const Hit& hit) const;
    /// Density of point(), per area.
    float point_density(std::uint32_t triangle) const {
        return sphere ? sphere_area_density(sphere->radius) : area_density[triangle];
    }

  private:
    /// Density per area within the patch, per triangle.
    const std::vector<float>& next_event_density() const {
        return patches.count() > 0 ? patches.density() : area_density;
    }

    /// Sample of any shape but a sphere, uniform by area.
    DirectSample sample_flat(const LightScene& scene, std::uint32_t patch, const Vec3& p, const Draw& random,
                             const Vec3* front) const {
        if (scene.geometry->triangle_count(shape) > 0) return sample_mesh(scene, patch, p, random, front);
        DirectSample sample;
        sample.on_light = uniform_point(*scene.geometry, shape, {to_unit(random[2]), to_unit(random[3])});
        look_at(sample, p, radiance, area_density[0]);
        return sample;
    }

    DirectSample sample_sphere(const LightScene& scene, const Vec3& p, const Draw& random, const Vec3* front) const {
        const Vec2 u = {to_unit(random[2]), to_unit(random[3])};
        const bool from_cone = by_cone && has_cone(*sphere, p);
        const auto draw = from_cone ? sample_by_cone : sample_by_area;
        return on_sphere(scene, draw(sphere->center, sphere->radius, p, u), from_cone, front);
    }

    /// Applies texture and mask to a sample's radiance.
    void shine(const LightScene& scene, DirectSample& sample) const {
        if (is_black(sample.radiance)) return;
        if (texture != kNone) sample.radiance = textured(scene, sample.on_light).rgb();
        // The shadow ray ends before the emitter and does not test its mask: the opacity is its expectation.
        if (mask) sample.radiance *= scene.geometry->opacity(sample.on_light);
    }
};

}  // namespace treefarm
