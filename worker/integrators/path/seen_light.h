// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/pending_light.h"
#include "worker/integrators/subpath/mis.h"

namespace treefarm {

template <class Surface>
BsdfValue bsdf_towards(const Surface& surface, const Vec3& wi) {
    return surface.bsdf().value(surface.wo(), surface.frame().to_local(wi));
}

/// Evaluates the BSDF for a visible light sample, unless it is known; false if it is black.
template <class G, class Surface>
bool reflects(const Surface& surface, PendingLight<G>& light) {
    if (!surface.evaluate_late()) return true;
    light.set(bsdf_towards(surface, light.wi));
    return !is_black(light.f_cos);
}

/// A visible light sample, weighted against scattering.
struct SeenLight {
    float scatter_pdf, light_pdf;  ///< light_pdf: of all light samples of the vertex together
    float weight;
    Rgb reflected;  ///< over the density
};

template <class G, bool kGuided>
SeenLight see_light(const PendingLight<G>& light, const typename G::Direction& direction,
                    const typename G::Sampler& guide, const PathSettings& settings) {
    SeenLight seen;
    seen.scatter_pdf = light.delta ? 0.0f : light.bsdf_pdf;
    if constexpr (kGuided)
        if (!light.delta) seen.scatter_pdf = G::pdf(guide, light.from.guidance, light.bsdf_pdf, direction);
    seen.light_pdf = light.pdf * light.from.light_samples;
    seen.weight = mis_weight(settings.mis, seen.light_pdf, seen.scatter_pdf);
    seen.reflected = light.f_cos * light.radiance * (seen.weight / seen.light_pdf);
    return seen;
}

/// Contribution of a light sample to the guided path's pixel, in luminance, weighted as in the unguided path.
template <class G>
float unguided_light(const PendingLight<G>& light, const SeenLight& seen, const PathSettings& settings) {
    const float weight = mis_weight(settings.mis, seen.light_pdf, light.delta ? 0.0f : light.bsdf_pdf);
    return luminance(light.from.throughput * (light.f_cos * light.radiance)) * (weight / seen.light_pdf);
}

}  // namespace treefarm
