// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/emitters.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

#include "common/base/error.h"

namespace treefarm {
namespace {

/// Sample of a direction towards infinity, without its density: pdf is 1 for a valid sample.
DirectSample towards_infinity(const Vec3& direction, const Vec3* front) {
    DirectSample sample;
    sample.from_environment = true;
    sample.distance = std::numeric_limits<float>::infinity();
    sample.wi = direction;
    if (sees(front, direction)) sample.pdf = 1.0f;
    return sample;
}

constexpr std::uint32_t kNoLight = 0xffffffffu;

double bounding_radius(const Box3& bounds) {
    if (bounds.isEmpty()) return 1.0;
    const Imath::V3d size = Imath::V3d(bounds.max) - Imath::V3d(bounds.min);
    const double radius = 0.5 * std::sqrt(size.dot(size));
    return radius > 0 ? radius : 1.0;
}

}  // namespace

Emitters::Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& box,
                   const TextureSet* textures, LightSelection how)
    : scene_{&geometry, textures}, light_of_shape_(geometry.shape_count(), kNone), ball_(box) {
    const double radius = bounding_radius(box);
    std::vector<double> power, delta_power;
    // Each light class names its kind of emitter: a kind without a light class does not compile.
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
    // Flux through the scene's bounding sphere, as seen by a surface: pi L times its cross-section.
    const double from_infinity = double(kPi) * radius * radius * double(kPi);
    environments_.for_each_part(
        [&](const auto& light, int part) { power.push_back(light.power(part, from_infinity)); });
    select(std::move(power), how);
}

double Emitters::add_area_light(const AreaEmitter& emitter) {
    AreaLight light(emitter, scene_);
    has_spheres_ |= light.sphere != nullptr;
    light_of_shape_[light.shape] = static_cast<std::int32_t>(area_lights_.size());
    const double power = light.power(scene_);
    area_lights_.push_back(std::move(light));
    return power;
}

/// Sets the tables of choice. Each emitter has a least probability, since one chosen too rarely is noisy where it
/// dominates.
void Emitters::select(std::vector<double> power, LightSelection how) {
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
    area_entries_ = next;
    if (LightChoice::by_point(how))
        select_by_point(power, how);
    else
        choice_ = LightChoice(how, power, {});
    const auto others = static_cast<std::uint32_t>(delta_lights_.size());
    environments_.choose(area_entries_ + others,
                         [&](std::uint32_t entry) { return selection_.probability(entry - area_entries_ + next); });
}

void Emitters::select_by_point(std::span<const double> power, LightSelection how) {
    std::vector<double> of_entry;
    std::vector<LightBounds> bounds;
    for (std::uint32_t i = 0; i < area_lights_.size(); ++i) {
        AreaLight& light = area_lights_[i];
        constexpr float kLeastCut = 1.0f / 32;  // of the scene's radius: smaller lamps look alike from everywhere
        light.cut(scene_, ball_.radius * kLeastCut);
        first_entry_.push_back(static_cast<std::uint32_t>(of_entry.size()));
        for (std::uint32_t patch = 0; patch < light.patch_count(); ++patch) {
            light_of_entry_.push_back(i);
            of_entry.push_back(power[i] * light.share(patch));
            bounds.push_back(light.bounds(scene_, patch));
        }
    }
    area_entries_ = static_cast<std::uint32_t>(of_entry.size());
    if (area_entries_ == area_lights_.size()) {
        light_of_entry_.clear();
        first_entry_.clear();
    }
    of_entry.insert(of_entry.end(), power.begin() + static_cast<std::ptrdiff_t>(area_lights_.size()), power.end());
    for (const DeltaLight& light : delta_lights_)
        bounds.push_back(light.bounds());
    environments_.for_each_part([&](const auto& light, int part) { bounds.push_back(light.bounds(part)); });
    choice_ = LightChoice(how, of_entry, bounds);
}

/// Adds the choice of its emitter to a sample.
static void add_choice(DirectSample& sample, const LightPick& chosen) {
    if (!sample.from_environment) sample.pdf *= chosen.probability;  // an environment's density includes it already
    sample.cluster = chosen.cluster;
    sample.cluster_probability = chosen.cluster_probability;
}

inline DirectSample Emitters::sample(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const {
    const AreaEntry at = is_area(chosen.entry) ? area_entry(chosen.entry) : AreaEntry{kNoLight, 0};
    const bool plain = at.light != kNoLight && area_lights_[at.light].plain;
    DirectSample sample =
        plain ? area_lights_[at.light].sample_mesh(scene_, at.patch, receiver.p, random, receiver.normal())
              : sample_other(chosen, receiver, random);
    add_choice(sample, chosen);
    return sample;
}

DirectSample Emitters::sample_direct(const LightReceiver& receiver, const Draw& random) const {
    if (choice_.empty()) return {};
    return sample(choice_.pick(random, receiver), receiver, random);
}

void Emitters::choose(LightBatch& batch, std::uint32_t lane, const LightReceiver& receiver, const Draw& random) const {
    batch.receiver[lane] = receiver;
    batch.random[lane] = random;
    if (choice_.flat()) return batch.flat.add(lane, receiver, random[0]);
    batch.chosen[lane] = choice_.pick(random, receiver);
    file(batch, lane);
}

void Emitters::file(LightBatch& batch, std::uint32_t lane) const {
    const LightPick& chosen = batch.chosen[lane];
    const Draw& random = batch.random[lane];
    std::uint32_t number = LightBatch::kAlone;
    if (is_map(chosen.entry)) {
        number = batch.map.add(static_cast<int>(environments_.map_part(chosen.entry)), random);
    } else if (const AreaLight* light = sphere_light(chosen.entry)) {
        const Vec3& p = batch.receiver[lane].p;
        batch.by_cone[lane] = light->by_cone && has_cone(*light->sphere, p);
        number = batch.by_cone[lane] ? batch.cones.add(*light->sphere, p, random)
                                     : batch.spheres.add(*light->sphere, p, random);
    }
    batch.number[lane] = static_cast<std::uint8_t>(number);
}

void Emitters::draw(LightBatch& batch) const {
    if (const FlatLights* few = choice_.flat()) {
        few->pick(batch.flat);
        for (std::uint32_t point = 0; point < batch.flat.count; ++point) {
            const std::uint32_t lane = batch.flat.lane_of[point];
            batch.chosen[lane] = few->picked(batch.flat, point);
            file(batch, lane);
        }
    }
    if (has_map()) environments_.map().map().sample(batch.map);
    batch.cones.draw();
    batch.spheres.draw();
}

DirectSample Emitters::sample_direct(const LightBatch& batch, std::uint32_t lane, const Draw& random) const {
    const LightPick& chosen = batch.chosen[lane];
    const LightReceiver& receiver = batch.receiver[lane];
    const std::uint32_t number = batch.number[lane];
    if (number == LightBatch::kAlone) return sample(chosen, receiver, random);
    const bool map = is_map(chosen.entry), by_cone = !map && batch.by_cone[lane];
    DirectSample sample =
        map ? towards_infinity(batch.map.direction(number), receiver.normal())
            : area_lights_[area_entry(chosen.entry).light].on_sphere(
                  scene_, by_cone ? batch.cones[number] : batch.spheres[number], by_cone, receiver.normal());
    add_choice(sample, chosen);
    return sample;
}

float Emitters::environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf) const {
    const LightPick& chosen = batch.chosen[lane];
    if (!is_map(chosen.entry)) return pdf;
    return environments_.pdf_of<MapLight>(batch.map[batch.number[lane]],
                                          probabilities_at(batch.receiver[lane], chosen));
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

DirectSample Emitters::sample_other(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const {
    if (!is_area(chosen.entry)) return sample_without_area(chosen, receiver, random);
    const auto [light, patch] = area_entry(chosen.entry);
    return area_lights_[light].sample(scene_, patch, receiver.p, random, receiver.normal());
}

DirectSample Emitters::sample_without_area(const LightPick& chosen, const LightReceiver& receiver,
                                           const Draw& random) const {
    if (chosen.entry == LightPick::kNone) return {};
    const std::size_t index = chosen.entry - area_entries_;
    if (index < delta_lights_.size()) return delta_lights_[index].sample(receiver.p, 1.0f);
    DirectSample sample;
    environments_.sample(chosen.entry, random, [&]<class Light>(const typename Light::Sample& drawn) {
        sample = towards_infinity(drawn.direction, receiver.normal());
        if (sample.pdf > 0.0f) sample.pdf = environments_.pdf_of<Light>(drawn, probabilities_at(receiver, chosen));
    });
    return sample;
}

float Emitters::pdf_direct(const LightReceiver& receiver, const Vec3& wi, const Hit& hit) const {
    const std::int32_t index = light_of_shape_[hit.shape];
    if (index == kNone) return 0.0f;
    const auto light = static_cast<std::uint32_t>(index);
    return area_lights_[light].pdf(receiver.p, wi, hit, choice_.probability(entry_of(light, hit), receiver));
}

}  // namespace treefarm
