#include "worker/lights/emitters.h"

#include <limits>

namespace treefarm {
namespace {

/// Turns a density per area into one per steradian as seen along wi over a distance.
float per_steradian(float area_density, float distance2, float cosine) {
    return cosine > 0.0f ? area_density * distance2 / cosine : 0.0f;
}

float sphere_area_density(const Sphere& sphere) {
    return kInvFourPi / (sphere.radius * sphere.radius);
}

double bounding_radius(const Box3& bounds) {
    if (bounds.isEmpty()) return 1.0;
    const Imath::V3d size = Imath::V3d(bounds.max) - Imath::V3d(bounds.min);
    const double radius = 0.5 * std::sqrt(size.dot(size));
    return radius > 0 ? radius : 1.0;
}

}  // namespace

Emitters::Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds)
    : geometry_(&geometry), light_of_shape_(geometry.shape_count(), kNone) {
    std::vector<double> power;
    for (const Emitter& emitter : emitters) {
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) {
            if (area->shape != kNone) power.push_back(add_area_light(*area, geometry));
        } else
            environment_ += std::get<ConstantEmitter>(emitter.kind).radiance;
    }
    // What crosses the scene's bounding sphere, as seen by a surface: pi L times its cross-section.
    const double radius = bounding_radius(bounds);
    power.push_back(double(kPi) * radius * radius * double(kPi) * double(average(environment_)));
    selection_ = DiscreteTable(power);
    for (std::size_t i = 0; i < area_lights_.size(); ++i)
        area_lights_[i].selection = selection_.probability(static_cast<std::uint32_t>(i));
    environment_pdf_ = selection_.probability(static_cast<std::uint32_t>(area_lights_.size())) * kInvFourPi;
}

double Emitters::add_area_light(const AreaEmitter& emitter, const EmbreeScene& geometry) {
    AreaLight light;
    light.radiance = emitter.radiance.value;
    light.shape = static_cast<std::uint32_t>(emitter.shape);
    light.sphere = geometry.sphere(light.shape);
    double area = 0;
    if (light.sphere) {
        area = 4.0 * double(kPi) * double(light.sphere->radius) * double(light.sphere->radius);
    } else {
        std::vector<double> areas(geometry.triangle_count(light.shape));
        for (std::uint32_t i = 0; i < areas.size(); ++i)
            area += areas[i] = geometry.triangle_area(light.shape, i);
        light.triangles = DiscreteTable(areas);
        light.area_density.resize(areas.size(), 0.0f);
        for (std::uint32_t i = 0; i < areas.size(); ++i)
            if (areas[i] > 0)
                light.area_density[i] = static_cast<float>(double(light.triangles.probability(i)) / areas[i]);
    }
    light_of_shape_[light.shape] = static_cast<std::int32_t>(area_lights_.size());
    area_lights_.push_back(std::move(light));
    return area * double(kPi) * double(average(emitter.radiance.value));
}

DirectSample Emitters::sample_direct(const Vec3& p, const Draw& random) const {
    if (selection_.empty()) return {};
    const std::uint32_t chosen = selection_.pick(random[0]);
    if (chosen == area_lights_.size()) return sample_environment(random);
    const AreaLight& light = area_lights_[chosen];
    return light.sphere ? sample_sphere(light, p, random) : sample_mesh(light, p, random);
}

DirectSample Emitters::sample_mesh(const AreaLight& light, const Vec3& p, const Draw& random) const {
    DirectSample sample;
    const std::uint32_t triangle = light.triangles.pick(random[1]);
    const Vec2 b = square_to_triangle({to_unit(random[2]), to_unit(random[3])});
    sample.on_light = geometry_->triangle_point(light.shape, triangle, b.x, b.y);
    const Vec3 to_light = sample.on_light.p - p;
    const float distance2 = dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return sample;
    sample.distance = std::sqrt(distance2);
    sample.wi = to_light * (1.0f / sample.distance);
    const float cosine = -dot(sample.on_light.ng, sample.wi);
    sample.pdf = light.selection * per_steradian(light.area_density[triangle], distance2, std::abs(cosine));
    if (cosine > 0.0f) sample.radiance = light.radiance;
    return sample;
}

DirectSample Emitters::sample_sphere(const AreaLight& light, const Vec3& p, const Draw& random) const {
    DirectSample sample;
    const Vec2 u = {to_unit(random[2]), to_unit(random[3])};
    const SphereCone cone = sphere_cone(*light.sphere, p);
    if (cone.outside) {
        const ConeSample c = sample_cone(cone, u);
        sample.wi = c.direction;
        sample.on_light = geometry_->sphere_point(light.shape, c.normal);
        const Vec3 to_light = sample.on_light.p - p;
        sample.distance = std::sqrt(dot(to_light, to_light));
        sample.pdf = light.selection * cone.pdf();
        if (!light.sphere->flip_normals) sample.radiance = light.radiance;
        return sample;
    }
    sample.on_light = geometry_->sphere_point(light.shape, square_to_sphere(u));
    const Vec3 to_light = sample.on_light.p - p;
    const float distance2 = dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return sample;
    sample.distance = std::sqrt(distance2);
    sample.wi = to_light * (1.0f / sample.distance);
    const float cosine = -dot(sample.on_light.ng, sample.wi);
    sample.pdf = light.selection * per_steradian(sphere_area_density(*light.sphere), distance2, std::abs(cosine));
    if (cosine > 0.0f) sample.radiance = light.radiance;
    return sample;
}

DirectSample Emitters::sample_environment(const Draw& random) const {
    DirectSample sample;
    sample.wi = square_to_sphere({to_unit(random[2]), to_unit(random[3])});
    sample.distance = std::numeric_limits<float>::infinity();
    sample.pdf = environment_pdf_;
    sample.radiance = environment_;
    return sample;
}

float Emitters::pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit) const {
    const std::int32_t index = light_of_shape_[hit.shape];
    if (index == kNone) return 0.0f;
    const AreaLight& light = area_lights_[static_cast<std::size_t>(index)];
    float area_density;
    if (light.sphere) {
        const SphereCone cone = sphere_cone(*light.sphere, p);
        if (cone.outside) return light.selection * cone.pdf();
        area_density = sphere_area_density(*light.sphere);
    } else {
        area_density = light.area_density[hit.primitive];
    }
    const Vec3 to_light = hit.p - p;
    return light.selection * per_steradian(area_density, dot(to_light, to_light), std::abs(dot(hit.ng, wi)));
}

}  // namespace treefarm
