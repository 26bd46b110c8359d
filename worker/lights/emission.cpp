// SPDX-License-Identifier: Apache-2.0
// Light paths begin here: what of Emitters emits rays.
#include <cmath>

#include "worker/lights/emitters.h"

namespace treefarm {

EmissionSample Emitters::emit(const Draw& place, const Draw& direction) const {
    if (selection_.empty() || !(ball_.radius > 0.0f)) return {};
    const std::uint32_t entry = selection_.pick(place[0]);
    if (entry < area_lights_.size()) return emit_from_area(area_lights_[entry], place, direction);
    const std::size_t index = entry - area_lights_.size();
    if (index >= delta_lights_.size())
        return emit_from_infinity(area_entries_ + static_cast<std::uint32_t>(index), place, direction);
    EmissionSample sample = delta_lights_[index].emit(ball_, direction);
    const float selection = selection_.probability(entry);
    sample.weight *= 1.0f / selection;
    sample.place_pdf *= selection;
    return sample;
}

EmissionSample Emitters::emit_from_area(const AreaLight& light, const Draw& place, const Draw& direction) const {
    EmissionSample sample;
    float density;
    sample.start = light.point(scene_, place, density);
    const Vec3 local = square_to_cosine_hemisphere({to_unit(direction[0]), to_unit(direction[1])});
    sample.place_pdf = light.selection * density;
    if (!(sample.place_pdf > 0.0f)) return sample;
    sample.from = EmissionFrom::surface;
    sample.radiance = light.radiance_at(scene_, sample.start);
    // At the rim of the hemisphere: a cosine of 0 is as good as none.
    if (!(local.z > 0.0f)) return sample;
    const Vec3 away = normalize(Frame(sample.start.ng).to_world(local));
    sample.ray = {offset_origin(sample.start, away), away};
    sample.weight = sample.radiance * (kPi / sample.place_pdf);
    sample.direction_pdf = cosine_hemisphere_pdf(local.z);
    return sample;
}

EmissionSample Emitters::emit_from_infinity(std::uint32_t entry, const Draw& place, const Draw& direction) const {
    EmissionSample sample;
    environments_.sample(entry, place, [&]<class Light>(const typename Light::Sample& drawn) {
        const float pdf = environments_.pdf_of<Light>(drawn, EntryProbabilities());
        if (!(pdf > 0.0f)) return;
        sample = emitted_across(ball_, -drawn.direction, environments_.radiance(drawn.direction) * (1.0f / pdf),
                                {to_unit(direction[0]), to_unit(direction[1])}, EmissionFrom::environment);
        sample.place_pdf = pdf;
    });
    return sample;
}

EmissionDensity Emitters::emission_density(const Hit& start, const Vec3& away) const {
    const std::int32_t index = light_of_shape_[start.shape];
    const float cosine = dot(start.ng, away);
    if (index == kNone || !(cosine > 0.0f) || !(ball_.radius > 0.0f)) return {};
    const AreaLight& light = area_lights_[static_cast<std::size_t>(index)];
    return {light.selection * light.point_density(start.primitive), cosine_hemisphere_pdf(cosine)};
}

EmissionDensity Emitters::emission_density(const Vec3& direction) const {
    if (!(ball_.radius > 0.0f)) return {};
    return {environments_.pdf(direction, EntryProbabilities()), 1.0f / ball_.section()};
}

EmissionDensity Emitters::emission_density(const DirectSample& sample, const Draw& random, bool delta_alone) const {
    if (!sample.delta)
        return sample.from_environment ? emission_density(sample.wi) : emission_density(sample.on_light, -sample.wi);
    if (!(ball_.radius > 0.0f)) return {};
    const std::size_t light =
        delta_alone ? delta_alone_.pick(random[0]) : selection_.pick(random[0]) - area_lights_.size();
    return {delta_selection_[light], delta_lights_[light].direction_pdf(ball_, -sample.wi)};
}

double Emitters::next_event_pdf(const EmissionSample& start, const Vec3& p) const {
    if (start.is_delta()) return double(start.place_pdf);
    const Vec3 wi = -start.ray.direction;
    if (start.from == EmissionFrom::environment) return double(pdf_environment(wi));
    if (start.from != EmissionFrom::surface) return 0.0;
    const double pdf = double(pdf_direct(p, wi, start.start)) * start.place_factor(p);
    return std::isfinite(pdf) ? pdf : 0.0;  // it left along the surface
}

}  // namespace treefarm
