// SPDX-License-Identifier: Apache-2.0
// Start of light paths: the part of Emitters that emits rays.
#include <cmath>

#include "worker/lights/emitters.h"

namespace treefarm {

EmissionSample Emitters::emit(const Draw& position, const Draw& direction, const EmissionChoice* choice) const {
    if (selection_.empty() || !(ball_.radius > 0.0f)) return {};
    return choice ? emit_by(*choice, position, direction) : emit_by(emission_choice(), position, direction);
}

EmissionSample Emitters::emit_by(const EmissionChoice& choice, const Draw& position, const Draw& direction) const {
    const std::uint32_t entry = choice.pick(position[0]);
    const float selection = choice.probability(entry);
    const std::size_t index = entry - area_lights_.size();
    EmissionSample sample;
    if (entry < area_lights_.size()) {
        sample = emit_from_area(area_lights_[entry], selection, position, direction);
    } else if (index >= delta_lights_.size()) {
        sample = emit_from_infinity(area_entries_ + static_cast<std::uint32_t>(index), position, direction, choice);
    } else {
        sample = emit_from_point(index, selection, direction);
    }
    sample.entry = entry;
    return sample;
}

EmissionSample Emitters::emit_from_point(std::size_t index, float selection, const Draw& direction) const {
    EmissionSample sample = delta_lights_[index].emit(ball_, direction);
    sample.weight *= 1.0f / selection;
    sample.position_pdf *= selection;
    sample.delta_light = static_cast<std::uint32_t>(index);
    return sample;
}

EmissionSample Emitters::emit_from_area(const AreaLight& light, float selection, const Draw& position,
                                        const Draw& direction) const {
    EmissionSample sample;
    float density;
    sample.start = light.point(scene_, position, density);
    const Vec3 local = square_to_cosine_hemisphere({to_unit(direction[0]), to_unit(direction[1])});
    sample.position_pdf = selection * density;
    if (!(sample.position_pdf > 0.0f)) return sample;
    sample.from = EmissionFrom::surface;
    sample.radiance = light.radiance_at(scene_, sample.start);
    // At the rim of the hemisphere the cosine is 0: no ray.
    if (!(local.z > 0.0f)) return sample;
    const Vec3 away = normalize(Frame(sample.start.ng).to_world(local));
    sample.ray = {offset_origin(sample.start, away), away};
    sample.weight = sample.radiance * (kPi / sample.position_pdf);
    sample.direction_pdf = cosine_hemisphere_pdf(local.z);
    return sample;
}

EmissionSample Emitters::emit_from_infinity(std::uint32_t entry, const Draw& position, const Draw& direction,
                                            const EmissionChoice& choice) const {
    EmissionSample sample;
    environments_.sample(entry, position, [&]<class Light>(const typename Light::Sample& drawn) {
        const float pdf =
            environments_.pdf_of<Light>(drawn, emission_probabilities(choice.learned() ? &choice : nullptr));
        if (!(pdf > 0.0f)) return;
        sample = emitted_across(ball_, -drawn.direction, environments_.radiance(drawn.direction) * (1.0f / pdf),
                                {to_unit(direction[0]), to_unit(direction[1])}, EmissionFrom::environment);
        sample.position_pdf = pdf;
    });
    return sample;
}

EmissionDensity Emitters::emission_density(const Hit& start, const Vec3& away, const EmissionChoice* choice) const {
    const std::int32_t index = light_of_shape_[start.shape];
    const float cosine = dot(start.ng, away);
    if (index == kNone || !(cosine > 0.0f) || !(ball_.radius > 0.0f)) return {};
    const AreaLight& light = area_lights_[static_cast<std::size_t>(index)];
    const float selection = choice ? choice->probability(static_cast<std::uint32_t>(index)) : light.selection;
    return {selection * light.point_density(start.primitive), cosine_hemisphere_pdf(cosine)};
}

EmissionDensity Emitters::emission_density(const Vec3& direction, const EmissionChoice* choice) const {
    if (!(ball_.radius > 0.0f)) return {};
    const EmissionProbabilities by = emission_probabilities(choice && choice->learned() ? choice : nullptr);
    return {environments_.pdf(direction, by), 1.0f / ball_.section()};
}

EmissionDensity Emitters::emission_density(const DirectSample& sample, const LightReceiver& receiver,
                                           const Draw& random, bool delta_alone, const EmissionChoice* choice) const {
    if (!sample.delta)
        return sample.from_environment ? emission_density(sample.wi, choice)
                                       : emission_density(sample.on_light, -sample.wi, choice);
    if (!(ball_.radius > 0.0f)) return {};
    const std::uint32_t light =
        delta_alone ? delta_alone_.pick(random[0]) : choice_.pick(random, receiver).entry - area_entries_;
    const auto entry = static_cast<std::uint32_t>(area_lights_.size()) + light;
    return {choice ? choice->probability(entry) : selection_.probability(entry),
            delta_lights_[light].direction_pdf(ball_, -sample.wi)};
}

double Emitters::next_event_pdf(const EmissionSample& start, const LightReceiver& receiver) const {
    const Vec3 wi = -start.ray.direction;
    if (start.is_delta()) return double(choice_.probability(area_entries_ + start.delta_light, receiver));
    if (start.from == EmissionFrom::environment) return double(pdf_environment(receiver, wi));
    if (start.from != EmissionFrom::surface) return 0.0;
    const double pdf = double(pdf_direct(receiver, wi, start.start)) * start.position_factor(receiver.p);
    return std::isfinite(pdf) ? pdf : 0.0;  // the ray left along the surface
}

}  // namespace treefarm
