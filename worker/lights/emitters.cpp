// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/emitters.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "common/base/error.h"
#include "worker/geometry/primitive_points.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/sphere_sample.h"

namespace treefarm {
namespace {

/// Larger meshes would not stay in the cache.
constexpr std::size_t kMostFlat = 4096;

/// Whether a surface with this normal, if that matters, sees a direction.
bool sees(const Vec3* front, const Vec3& direction) {
    return !front || dot(*front, direction) > 0.0f;
}

/// A direction towards the environment, without its density yet: 1 stands for it where it is a sample.
DirectSample towards_infinity(const Vec3& direction, const Vec3* front) {
    DirectSample sample;
    sample.from_environment = true;
    sample.distance = std::numeric_limits<float>::infinity();
    sample.wi = direction;
    if (sees(front, direction)) sample.pdf = 1.0f;
    return sample;
}

double bounding_radius(const Box3& bounds) {
    if (bounds.isEmpty()) return 1.0;
    const Imath::V3d size = Imath::V3d(bounds.max) - Imath::V3d(bounds.min);
    const double radius = 0.5 * std::sqrt(size.dot(size));
    return radius > 0 ? radius : 1.0;
}

}  // namespace

Emitters::Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds,
                   const TextureSet* textures)
    : geometry_(&geometry), textures_(textures), light_of_shape_(geometry.shape_count(), kNone) {
    const double radius = bounding_radius(bounds);
    std::vector<double> power, delta_power;
    for (const Emitter& emitter : emitters) {
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) {
            if (area->shape != kNone) power.push_back(add_area_light(*area));
        } else if (const auto delta = DeltaLight::make(emitter, textures)) {
            delta_lights_.push_back(*delta);
            const auto* spot = std::get_if<SpotEmitter>(&emitter.kind);
            const bool projects = spot && spot->texture != kNone;
            delta_power.push_back(delta->power(radius) *
                                  (projects ? double(average(mean_color(*textures, spot->texture))) : 1.0));
        } else if (const auto* constant = std::get_if<ConstantEmitter>(&emitter.kind)) {
            constant_ += constant->radiance;
        } else if (const auto* image = std::get_if<EnvironmentEmitter>(&emitter.kind)) {
            if (map_) throw RunError("the scene has two environment maps");
            if (!textures || image->image < 0 || static_cast<std::size_t>(image->image) >= textures->images().size())
                throw RunError("the image of an environment map is missing");
            map_ = std::make_unique<EnvironmentMap>(*image, textures->images()[static_cast<std::size_t>(image->image)]);
        }
    }
    shines_from_infinity_ = map_ || !is_black(constant_);
    power.insert(power.end(), delta_power.begin(), delta_power.end());
    // What crosses the scene's bounding sphere, as seen by a surface: pi L times its cross-section.
    const double from_infinity = double(kPi) * radius * radius * double(kPi);
    power.push_back(from_infinity * double(average(constant_)));
    for (int part = 0; map_ && part < map_->part_count(); ++part)
        power.push_back(from_infinity * map_->mean_radiance() * map_->part_weight(part));
    select(std::move(power));
}

/// An emitter that is hardly ever chosen would be all noise where it is the only one that counts.
void Emitters::select(std::vector<double> power) {
    const auto shining = std::count_if(power.begin(), power.end(), [](double p) { return p > 0; });
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    const double least = shining > 0 ? 1e-3 * total / static_cast<double>(shining) : 0.0;
    for (double& p : power)
        if (p > 0) p = std::max(p, least);
    const auto first_delta = power.begin() + static_cast<std::ptrdiff_t>(area_lights_.size());
    delta_alone_ = DiscreteTable(std::span<const double>(first_delta, delta_lights_.size()));
    selection_ = DiscreteTable(power);
    std::uint32_t next = 0;
    for (AreaLight& light : area_lights_)
        light.selection = selection_.probability(next++);
    for (std::size_t i = 0; i < delta_lights_.size(); ++i)
        delta_selection_.push_back(selection_.probability(next++));
    constant_entry_ = next;
    constant_pdf_ = selection_.probability(next++) * kInvFourPi;
    for (int part = 0; map_ && part < map_->part_count(); ++part)
        map_parts_[static_cast<std::size_t>(part)] = selection_.probability(next++);
    clusters_ = LightClusters(selection_);
}

EnvironmentMap::PartChoice Emitters::part_choice(const LightShare* share) const {
    if (!share) return map_parts_;
    EnvironmentMap::PartChoice choice = map_parts_;
    for (int part = 0; part < map_->part_count(); ++part)
        choice[static_cast<std::size_t>(part)] *=
            clusters_.factor(share, constant_entry_ + 1 + static_cast<std::uint32_t>(part));
    return choice;
}

double Emitters::add_area_light(const AreaEmitter& emitter) {
    AreaLight light;
    light.radiance = emitter.radiance.value;
    light.texture = emitter.radiance.texture;
    light.shape = static_cast<std::uint32_t>(emitter.shape);
    light.sphere = geometry_->sphere(light.shape);
    light.mask = geometry_->mask(light.shape);
    light.by_cone = light.sphere && !(light.mask && light.sphere->flip_normals);
    if (light.texture != kNone && !textures_) throw RunError("an emitter has a texture, but there are no textures");
    const std::vector<double> areas = part_areas(*geometry_, light.shape);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    if (!light.sphere) {
        light.triangles = DiscreteTable(areas);
        light.area_density.resize(areas.size(), 0.0f);
        for (std::uint32_t i = 0; i < areas.size(); ++i)
            if (areas[i] > 0)
                light.area_density[i] = static_cast<float>(double(light.triangles.probability(i)) / areas[i]);
    }
    light.plain = geometry_->triangle_count(light.shape) > 0 && light.texture == kNone && !light.mask;
    if (light.plain && areas.size() <= kMostFlat) light.flat = geometry_->flat_triangles(light.shape);
    has_spheres_ |= light.sphere != nullptr;
    light_of_shape_[light.shape] = static_cast<std::int32_t>(area_lights_.size());
    area_lights_.push_back(std::move(light));
    const Rgb mean = emitter.radiance.value *
                     (emitter.radiance.varies() ? mean_color(*textures_, emitter.radiance.texture) : Rgb(1.0f));
    return area * double(kPi) * double(average(mean));
}

Emitters::Channels Emitters::textured(const AreaLight& light, const Hit& hit) const {
    const Rgb c = light.radiance * textures_->color(light.texture, geometry_->uv(hit));
    return {c.x, c.y, c.z};
}

/// Adds what is known of the choice of its emitter.
static void add_choice(DirectSample& sample, const LightClusters::Choice& choice) {
    if (!sample.from_environment) sample.pdf *= choice.factor;  // the environment has it in its density
    sample.cluster = choice.cluster;
    sample.cluster_probability = choice.probability;
}

inline DirectSample Emitters::sample(const ChosenEmitter& chosen, const Vec3& p, const Draw& random,
                                     const LightShare* share, const Vec3* front) const {
    const bool plain = chosen.entry < area_lights_.size() && area_lights_[chosen.entry].plain;
    DirectSample sample = plain ? sample_mesh(area_lights_[chosen.entry], p, random, front)
                                : sample_other(chosen.entry, p, random, share, front);
    add_choice(sample, chosen.cluster);
    return sample;
}

DirectSample Emitters::sample_direct(const Vec3& p, const Draw& random, const LightShare* share,
                                     const Vec3* front) const {
    if (selection_.empty()) return {};
    return sample(choose(random, share), p, random, share, front);
}

void Emitters::choose(LightBatch& batch, std::uint32_t lane, const Vec3& p, const Draw& random,
                      const LightShare* share) const {
    const ChosenEmitter chosen = batch.chosen[lane] = choose(random, share);
    std::uint32_t number = LightBatch::kAlone;
    if (is_map(chosen.entry)) {
        number = batch.map.add(part_of(chosen.entry), random);
    } else if (const AreaLight* light = sphere_light(chosen.entry)) {
        batch.by_cone[lane] = light->by_cone && has_cone(*light->sphere, p);
        number = batch.by_cone[lane] ? batch.cones.add(*light->sphere, p, random)
                                     : batch.spheres.add(*light->sphere, p, random);
    }
    batch.number[lane] = static_cast<std::uint8_t>(number);
}

void Emitters::draw(LightBatch& batch) const {
    if (has_map()) map_->sample(batch.map);
    batch.cones.draw();
    batch.spheres.draw();
}

DirectSample Emitters::sample_direct(const Vec3& p, const LightBatch& batch, std::uint32_t lane, const Draw& random,
                                     const LightShare* share, const Vec3* front) const {
    const ChosenEmitter& chosen = batch.chosen[lane];
    const std::uint32_t number = batch.number[lane];
    if (number == LightBatch::kAlone) return sample(chosen, p, random, share, front);
    const bool map = is_map(chosen.entry), by_cone = !map && batch.by_cone[lane];
    DirectSample sample = map ? towards_infinity(batch.map.direction(number), front)
                              : on_sphere(area_lights_[chosen.entry],
                                          by_cone ? batch.cones[number] : batch.spheres[number], by_cone, front);
    add_choice(sample, chosen.cluster);
    return sample;
}

float Emitters::environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf, const LightShare* share) const {
    return is_map(batch.chosen[lane].entry) ? map_pdf(batch.map[batch.number[lane]], share) : pdf;
}

Rgb Emitters::environment(const LightBatch& batch, std::uint32_t lane, const Vec3& direction) const {
    return is_map(batch.chosen[lane].entry) ? constant_ + map_->radiance(batch.map.place(batch.number[lane]))
                                            : environment(direction);
}

void Emitters::prefetch_environment(const LightBatch& batch, std::uint32_t lane) const {
    if (is_map(batch.chosen[lane].entry)) map_->prefetch(batch.map.place(batch.number[lane]));
}

DirectSample Emitters::sample_delta(const Vec3& p, const Draw& random) const {
    if (delta_alone_.empty()) return {};
    const std::uint32_t chosen = delta_alone_.pick(random[0]);
    return delta_lights_[chosen].sample(p, delta_alone_.probability(chosen));
}

DirectSample Emitters::sample_other(std::uint32_t entry, const Vec3& p, const Draw& random, const LightShare* share,
                                    const Vec3* front) const {
    if (entry >= area_lights_.size()) return sample_without_area(entry, p, random, share, front);
    const AreaLight& light = area_lights_[entry];
    if (light.sphere) return sample_sphere(light, p, random, front);
    DirectSample sample = sample_area(light, p, random, front);
    shine(light, sample);
    return sample;
}

/// Adds what texture and mask of an emitter make of its radiance.
inline void Emitters::shine(const AreaLight& light, DirectSample& sample) const {
    if (is_black(sample.radiance)) return;
    if (kHasTextures && light.texture != kNone) sample.radiance = textured(light, sample.on_light).rgb();
    // The shadow ray ends before the emitter, so its own mask is not asked: on average it lets this much be seen.
    if (kHasMasks && light.mask) sample.radiance *= geometry_->opacity(sample.on_light);
}

DirectSample Emitters::sample_mesh(const AreaLight& light, const Vec3& p, const Draw& random, const Vec3* front) const {
    const std::uint32_t triangle = light.triangles.pick(random[1]);
    const Vec2 b = square_to_triangle({to_unit(random[2]), to_unit(random[3])});
    DirectSample sample;
    Hit& hit = sample.on_light;
    if (light.flat.empty()) {
        geometry_->set_triangle_point(hit, light.shape, triangle, b.x, b.y);
    } else {
        hit.shape = light.shape;
        hit.primitive = triangle;
        light.flat[triangle].set_point(hit, b.x, b.y);
    }
    if (front && !(dot(*front, hit.p - p) > 0.0f && dot(hit.ng, p - hit.p) > 0.0f)) return sample;
    look_at(sample, p, light.radiance, light.selection, light.area_density[triangle]);
    return sample;
}

/// Any shape but a sphere, uniformly by area.
DirectSample Emitters::sample_area(const AreaLight& light, const Vec3& p, const Draw& random, const Vec3* front) const {
    if (geometry_->triangle_count(light.shape) > 0) return sample_mesh(light, p, random, front);
    DirectSample sample;
    sample.on_light = uniform_point(*geometry_, light.shape, {to_unit(random[2]), to_unit(random[3])});
    look_at(sample, p, light.radiance, light.selection, light.area_density[0]);
    return sample;
}

DirectSample Emitters::sample_sphere(const AreaLight& light, const Vec3& p, const Draw& random,
                                     const Vec3* front) const {
    const Sphere& sphere = *light.sphere;
    const Vec2 u = {to_unit(random[2]), to_unit(random[3])};
    const bool by_cone = light.by_cone && has_cone(sphere, p);
    const auto sample = by_cone ? sample_by_cone : sample_by_area;
    return on_sphere(light, sample(sphere.center, sphere.radius, p, u), by_cone, front);
}

DirectSample Emitters::on_sphere(const AreaLight& light, const SphereSample& drawn, bool by_cone,
                                 const Vec3* front) const {
    DirectSample sample;
    if (!(drawn.pdf > 0.0f) || !sees(front, drawn.direction)) return sample;
    sample.wi = drawn.direction;
    sample.on_light = sphere_hit(*light.sphere, drawn.p, drawn.normal);
    sample.on_light.shape = light.shape;
    sample.distance = drawn.distance;
    sample.pdf = light.selection * drawn.pdf;
    // What a cone meets first is the outside, also where rounding has it beyond the rim.
    const bool shines = by_cone ? !light.sphere->flip_normals : dot(sample.on_light.ng, drawn.direction) < 0.0f;
    if (shines) sample.radiance = light.radiance;
    shine(light, sample);
    return sample;
}

DirectSample Emitters::sample_without_area(std::uint32_t entry, const Vec3& p, const Draw& random,
                                           const LightShare* share, const Vec3* front) const {
    const std::size_t index = entry - area_lights_.size();
    if (index < delta_lights_.size()) return delta_lights_[index].sample(p, delta_selection_[index]);
    DirectSample sample;
    if constexpr (!kHasEnvironment) return sample;
    if (is_map(entry)) {
        const EnvironmentSample drawn = map_->sample(part_of(entry), random);
        sample = towards_infinity(drawn.direction, front);
        if (sample.pdf > 0.0f) sample.pdf = map_pdf(drawn, share);
        return sample;
    }
    sample = towards_infinity(square_to_sphere({to_unit(random[2]), to_unit(random[3])}), front);
    if (sample.pdf > 0.0f) sample.pdf = pdf_environment(sample.wi, share);
    return sample;
}

float Emitters::map_pdf(const EnvironmentSample& drawn, const LightShare* share) const {
    return constant_pdf(share) + map_->pdf(drawn, part_choice(share));
}

float Emitters::pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit, const LightShare* share) const {
    const std::int32_t index = light_of_shape_[hit.shape];
    if (index == kNone) return 0.0f;
    const AreaLight& light = area_lights_[static_cast<std::size_t>(index)];
    const float selection = light.selection * clusters_.factor(share, static_cast<std::uint32_t>(index));
    float area_density;
    if (light.sphere) {
        const SphereCone cone = sphere_cone(*light.sphere, p);
        if (cone.outside && light.by_cone) return selection * cone.pdf();
        area_density = sphere_area_density(light.sphere->radius);
    } else {
        area_density = light.area_density[hit.primitive];
    }
    const Vec3 to_light = hit.p - p;
    return selection * per_steradian(area_density, dot(to_light, to_light), std::abs(dot(hit.ng, wi)));
}

}  // namespace treefarm
