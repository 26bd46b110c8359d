// SPDX-License-Identifier: Apache-2.0
#include "worker/tools/inspect_film.h"

#include <limits>

#include "common/base/hash.h"

namespace treefarm {

Rgb hashed_colour(std::uint32_t number) {
    const std::uint64_t bits = mix_bits(number + 1);
    const auto channel = [&](int shift) { return 0.05f + 0.8f * static_cast<float>((bits >> shift) & 255) / 255.0f; };
    return {channel(0), channel(20), channel(40)};
}

FilmMaps film_maps(const TraceScene& scene, const AnyModel& tree, const AnySampler& guide) {
    const int width = scene.film().width, height = scene.film().height;
    const std::vector<double> cells = tree.cells_by_region();
    FilmMaps maps{RgbImage(width, height), Plane(width, height), Plane(width, height), Plane(width, height)};
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i) {
            maps.bsdf_fraction.values[i] = maps.view_fraction.values[i] = maps.cells.values[i] =
                std::numeric_limits<float>::quiet_NaN();
            const std::optional<InspectedPoint> point = seen_point(scene, x, y);
            if (!point) continue;
            const PointFacts facts = point_facts(scene, guide, *point);
            maps.regions.pixels[i] = hashed_colour(facts.guidance.region);
            maps.cells.values[i] = static_cast<float>(cells[facts.guidance.region]);
            if (facts.black || !facts.smooth) continue;
            maps.bsdf_fraction.values[i] = facts.guidance.bsdf_fraction;
            maps.view_fraction.values[i] = facts.guidance.view_fraction;
        }
    return maps;
}

}  // namespace treefarm
