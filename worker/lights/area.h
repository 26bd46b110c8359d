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

/// Whether a surface with this normal, if that matters, sees a direction.
inline bool sees(const Vec3* front, const Vec3& direction) {
    return !front || dot(*front, direction) > 0.0f;
}

/// What area lights are part of.
struct LightScene {
    const EmbreeScene* geometry;
    const TextureSet* textures;  ///< nullptr: there are none
};

/// A shape that emits, with the probabilities of its triangles. Disks and cylinders count as one triangle. `front`:
/// normal of a surface at p that reflects only (Emitters::sample_direct).
struct AreaLight {
    /// A colour that is returned in registers: the rare case then does not force the frequent one through memory.
    struct Channels {
        float r, g, b;
        Rgb rgb() const { return {r, g, b}; }
    };

    Rgb radiance{0.0f};  ///< or what its texture is multiplied by
    std::int32_t texture = kNone;
    std::uint32_t shape = 0;
    const Sphere* sphere = nullptr;
    bool plain = false;               ///< a mesh without texture or mask
    float selection = 0;              ///< probability that this light is chosen by power
    DiscreteTable triangles;          ///< meshes
    AreaPatches patches;              ///< of next event; uncut unless cut() was called
    std::vector<float> area_density;  ///< per triangle: per area, within this light; none for spheres
    std::vector<FlatTriangle> flat;   ///< of a plain mesh without shading normals that is not large
    const Mask* mask = nullptr;
    /// Spheres: sampled by their cone from outside. Not those that shine inwards through the holes of a mask.
    bool by_cone = false;

    /// Throws RunError if it has a texture and there are none.
    AreaLight(const AreaEmitter& emitter, const LightScene& scene);

    /// Mean radiance over the surface, masks aside.
    Rgb mean_radiance(const LightScene& scene) const;
    /// Mean of the channels, in watts.
    double power(const LightScene& scene) const;

    /// Cuts a mesh into patches, if that is worth its while.
    void cut(const LightScene& scene, float least_extent);
    /// How many next event chooses among: 1 where it is uncut.
    std::uint32_t patch_count() const { return std::max(patches.count(), 1u); }
    /// Share of a patch in its power.
    double share(std::uint32_t patch) const { return patches.count() > 0 ? patches.share(patch) : 1.0; }
    /// The patch of what was hit.
    std::uint32_t patch_of(const Hit& hit) const { return patches.count() > 0 ? patches.patch_of(hit.primitive) : 0; }
    /// The place and the light of a patch's points.
    LightBounds bounds(const LightScene& scene, std::uint32_t patch) const;

    /// Radiance of what was hit, where a texture varies it.
    Channels textured(const LightScene& scene, const Hit& hit) const;

    /// Whatever it is, as if there were no other light or patch. random[1] chooses the triangle, [2] and [3] the place.
    DirectSample sample(const LightScene& scene, std::uint32_t patch, const Vec3& p, const Draw& random,
                        const Vec3* front) const {
        if (sphere) return sample_sphere(scene, p, random, front);
        DirectSample sample = sample_flat(scene, patch, p, random, front);
        shine(scene, sample);
        return sample;
    }

    /// A mesh, without what texture and mask make of its radiance.
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

    /// A place on its sphere that was drawn.
    DirectSample on_sphere(const LightScene& scene, const SphereSample& drawn, bool from_cone,
                           const Vec3* front) const {
        DirectSample sample;
        if (!(drawn.pdf > 0.0f) || !sees(front, drawn.direction)) return sample;
        sample.wi = drawn.direction;
        sample.on_light = sphere_hit(*sphere, drawn.p, drawn.normal);
        sample.on_light.shape = shape;
        sample.distance = drawn.distance;
        sample.pdf = drawn.pdf;
        // What a cone meets first is the outside, also where rounding has it beyond the rim.
        const bool shines = from_cone ? !sphere->flip_normals : dot(sample.on_light.ng, drawn.direction) < 0.0f;
        if (shines) sample.radiance = radiance;
        shine(scene, sample);
        return sample;
    }

    /// Density per steradian of sample() for what is hit from p along wi, where its patch is chosen with this
    /// probability.
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

    /// A point that is uniform by area, whatever it is: random[1] chooses the triangle, [2] and [3] the place.
    /// `density` becomes that per area, within this light.
    Hit point(const LightScene& scene, const Draw& random, float& density) const;
    /// Radiance that leaves a point of it on its front, with what a mask lets be there on average.
    Rgb radiance_at(const LightScene& scene, const Hit& hit) const;
    /// Density of point(), per area.
    float point_density(std::uint32_t triangle) const {
        return sphere ? sphere_area_density(sphere->radius) : area_density[triangle];
    }

  private:
    /// Per triangle: per area, within its patch.
    const std::vector<float>& next_event_density() const {
        return patches.count() > 0 ? patches.density() : area_density;
    }

    /// A sample of any shape but a sphere, uniform by area.
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

    /// Adds what texture and mask make of its radiance.
    void shine(const LightScene& scene, DirectSample& sample) const {
        if (is_black(sample.radiance)) return;
        if (texture != kNone) sample.radiance = textured(scene, sample.on_light).rgb();
        // The shadow ray ends before the emitter, so its own mask is not asked: on average it lets this much be seen.
        if (mask) sample.radiance *= scene.geometry->opacity(sample.on_light);
    }
};

}  // namespace treefarm
