// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/emitters.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

#include "common/base/error.h"

namespace treefarm {
namespace {

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
    : scene_{&geometry, textures}, light_of_shape_(geometry.shape_count(), kNone), ball_(bounds) {
    const double radius = bounding_radius(bounds);
    std::vector<double> power, delta_power;
    // Each kind of emitter is named by its type of light: a new one does not compile before there is a light for it.
    const auto add = [&]<class Kind>(const Kind& kind, const Emitter& emitter) {
        if constexpr (std::is_same_v<Kind, AreaEmitter>) {
            if (kind.shape != kNone) power.push_back(add_area_light(kind));
        } else if constexpr (Kind::kTraits.type == LightType::delta) {
            delta_lights_.push_back(*DeltaLight::make(emitter, textures));
            delta_power.push_back(delta_lights_.back().power(radius));
        } else {
            environments_.add(kind, textures);
        }
    };
    for (const Emitter& emitter : emitters)
        std::visit([&](const auto& kind) { add(kind, emitter); }, emitter.kind);
    shines_from_infinity_ = environments_.shines();
    power.insert(power.end(), delta_power.begin(), delta_power.end());
    // What crosses the scene's bounding sphere, as seen by a surface: pi L times its cross-section.
    const double from_infinity = double(kPi) * radius * radius * double(kPi);
    environments_.for_each_power(from_infinity, [&](double of_part) { power.push_back(of_part); });
    select(std::move(power));
}

double Emitters::add_area_light(const AreaEmitter& emitter) {
    AreaLight light(emitter, scene_);
    has_spheres_ |= light.sphere != nullptr;
    light_of_shape_[light.shape] = static_cast<std::int32_t>(area_lights_.size());
    const double power = light.power(scene_);
    area_lights_.push_back(std::move(light));
    return power;
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
    environments_.choose(next, [&](std::uint32_t entry) { return selection_.probability(entry); });
    clusters_ = LightClusters(selection_);
}

/// Adds what is known of the choice of its emitter.
static void add_choice(DirectSample& sample, const LightClusters::Choice& choice) {
    if (!sample.from_environment) sample.pdf *= choice.factor;  // the environment has it in its density
    sample.cluster = choice.cluster;
    sample.cluster_probability = choice.probability;
}

inline DirectSample Emitters::sample(const ChosenEmitter& chosen, const Vec3& p, const Draw& random,
                                     const LightProbabilities* probabilities, const Vec3* front) const {
    const bool plain = chosen.entry < area_lights_.size() && area_lights_[chosen.entry].plain;
    DirectSample sample = plain ? area_lights_[chosen.entry].sample_mesh(scene_, p, random, front)
                                : sample_other(chosen.entry, p, random, probabilities, front);
    add_choice(sample, chosen.cluster);
    return sample;
}

DirectSample Emitters::sample_direct(const Vec3& p, const Draw& random, const LightProbabilities* probabilities,
                                     const Vec3* front) const {
    if (selection_.empty()) return {};
    return sample(choose(random, probabilities), p, random, probabilities, front);
}

void Emitters::choose(LightBatch& batch, std::uint32_t lane, const Vec3& p, const Draw& random,
                      const LightProbabilities* probabilities) const {
    const ChosenEmitter chosen = batch.chosen[lane] = choose(random, probabilities);
    std::uint32_t number = LightBatch::kAlone;
    if (is_map(chosen.entry)) {
        number = batch.map.add(static_cast<int>(environments_.map_part(chosen.entry)), random);
    } else if (const AreaLight* light = sphere_light(chosen.entry)) {
        batch.by_cone[lane] = light->by_cone && has_cone(*light->sphere, p);
        number = batch.by_cone[lane] ? batch.cones.add(*light->sphere, p, random)
                                     : batch.spheres.add(*light->sphere, p, random);
    }
    batch.number[lane] = static_cast<std::uint8_t>(number);
}

void Emitters::draw(LightBatch& batch) const {
    if (has_map()) environments_.map().map().sample(batch.map);
    batch.cones.draw();
    batch.spheres.draw();
}

DirectSample Emitters::sample_direct(const Vec3& p, const LightBatch& batch, std::uint32_t lane, const Draw& random,
                                     const LightProbabilities* probabilities, const Vec3* front) const {
    const ChosenEmitter& chosen = batch.chosen[lane];
    const std::uint32_t number = batch.number[lane];
    if (number == LightBatch::kAlone) return sample(chosen, p, random, probabilities, front);
    const bool map = is_map(chosen.entry), by_cone = !map && batch.by_cone[lane];
    DirectSample sample = map ? towards_infinity(batch.map.direction(number), front)
                              : area_lights_[chosen.entry].on_sphere(
                                    scene_, by_cone ? batch.cones[number] : batch.spheres[number], by_cone, front);
    add_choice(sample, chosen.cluster);
    return sample;
}

float Emitters::environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf,
                                const LightProbabilities* probabilities) const {
    return is_map(batch.chosen[lane].entry) ? map_pdf(batch.map[batch.number[lane]], probabilities) : pdf;
}

Rgb Emitters::environment(const LightBatch& batch, std::uint32_t lane, const Vec3& direction) const {
    if (!is_map(batch.chosen[lane].entry)) return environment(direction);
    return environments_.radiance_with<MapLight>(direction, [&](const MapLight& light) {
        return light.map().radiance(batch.map.footprint(batch.number[lane]));
    });
}

void Emitters::prefetch_environment(const LightBatch& batch, std::uint32_t lane) const {
    if (is_map(batch.chosen[lane].entry)) environments_.map().map().prefetch(batch.map.footprint(batch.number[lane]));
}

DirectSample Emitters::sample_delta(const Vec3& p, const Draw& random) const {
    if (delta_alone_.empty()) return {};
    const std::uint32_t chosen = delta_alone_.pick(random[0]);
    return delta_lights_[chosen].sample(p, delta_alone_.probability(chosen));
}

DirectSample Emitters::sample_other(std::uint32_t entry, const Vec3& p, const Draw& random,
                                    const LightProbabilities* probabilities, const Vec3* front) const {
    if (entry >= area_lights_.size()) return sample_without_area(entry, p, random, probabilities, front);
    return area_lights_[entry].sample(scene_, p, random, front);
}

DirectSample Emitters::sample_without_area(std::uint32_t entry, const Vec3& p, const Draw& random,
                                           const LightProbabilities* probabilities, const Vec3* front) const {
    const std::size_t index = entry - area_lights_.size();
    if (index < delta_lights_.size()) return delta_lights_[index].sample(p, delta_selection_[index]);
    DirectSample sample;
    environments_.sample(entry, random, [&]<class Light>(const typename Light::Sample& drawn) {
        sample = towards_infinity(drawn.direction, front);
        if (sample.pdf > 0.0f) sample.pdf = environments_.pdf_of<Light>(drawn, clusters_, probabilities);
    });
    return sample;
}

float Emitters::map_pdf(const EnvironmentSample& drawn, const LightProbabilities* probabilities) const {
    return environments_.pdf_of<MapLight>(drawn, clusters_, probabilities);
}

float Emitters::pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit,
                           const LightProbabilities* probabilities) const {
    const std::int32_t index = light_of_shape_[hit.shape];
    if (index == kNone) return 0.0f;
    const float factor = clusters_.factor(probabilities, static_cast<std::uint32_t>(index));
    return area_lights_[static_cast<std::size_t>(index)].pdf(p, wi, hit, factor);
}

}  // namespace treefarm
