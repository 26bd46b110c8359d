// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/config/aov_list.h"
#include "common/film/aov_film.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "tests/support/material_scenes.h"
#include "worker/registry.h"

namespace treefarm::test {

/// A pass of unguided samples, as one chunk.
inline PassPlan one_pass(std::uint32_t spp) {
    PassPlan pass;
    pass.spp = spp;
    pass.blocks_per_unit = 16;
    return pass;
}

/// AOV layers of a small film after a job's unguided passes, channel by channel, with the last pass's own result.
struct Layers {
    std::vector<AovChannel> channels;
    std::vector<PixelEstimate> pixels, direct;
    UnitStats stats;

    const std::vector<float>& operator[](const std::string& name) const {
        for (const AovChannel& channel : channels)
            if (channel.name == name) return channel.values;
        throw RunError("no channel " + name);
    }
    Vec3 vector(const std::string& layer, std::size_t p, const char* names = "XYZ") const {
        const auto at = [&](int c) { return (*this)[layer + "." + names[c]][p]; };
        return {at(0), at(1), at(2)};
    }
};

inline Layers render_layers(const Scene& scene, const std::string& aovs, const std::vector<PassPlan>& plans,
                            Job job = {}) {
    job.guiding.type = GuidingType::none;
    job.output.aovs = aovs;
    const Resolved resolved = resolve(job, scene);
    const RenderUnit renderer = make_renderer(scene, resolved);
    const AnyModel tree = first_model(resolved, scene.bounds(), 1.0f);
    const AnySampler guide(tree);
    const int width = scene.film.width, height = scene.film.height;
    Layers result;
    AovSums sums(aov_requests(resolved), scene.film.pixel_count());
    std::vector<PassResult> passes;
    for (PassPlan pass : plans) {
        pass.next_event = job.integrator.next_event == NextEvent::always || resolved.decides_next_event;
        pass.kernel = kernel_of(resolved, pass, facts_of(tree));
        const PassPlan planned = make_pass(resolved, pass.index, pass.first_sample, pass.spp, true);
        pass.units = planned.units;
        pass.layers = planned.layers;
        PassFilm film(width, height, pass.chunks);
        SplatSums splats(pass.layers.splats);
        AovFilm layers(AovLayout(aov_requests(resolved)), width, height, pass.chunks);
        UnitOutput output;
        result.stats = {};
        for (const WorkUnit& unit : cut_pass(pass, width, height, width)) {
            output.begin(guide, pass.layers.splats);
            renderer(pass, guide, unit, output);
            if (pass.layers.estimates) film.add(unit, output.pixels);
            splats.add(output.splats.summed(), output.splats.caps());
            if (pass.layers.estimates) layers.add(unit, output.aovs);
            result.stats.add(output.stats);
        }
        AovPixels whole = layers.take();
        sums.add(whole, pass.spp);
        result.direct = std::move(whole.direct);
        passes.emplace_back();
        passes.back().spp = pass.spp;
        passes.back().pixels = develop(pass.layers.estimates ? film.pixels() : std::vector<PixelEstimate>(), splats,
                                       pass.splatting_paths(), pass.splatting_chains());
    }
    result.channels = sums.channels(combine_passes(passes, Combination::fixed, false), passes);
    result.pixels = std::move(passes.back().pixels);
    return result;
}

inline Layers render_layers(const Scene& scene, const std::string& aovs, std::uint32_t spp = 16, Job job = {}) {
    return render_layers(scene, aovs, std::vector{one_pass(spp)}, std::move(job));
}

/// A wall seen along +z from the origin on a film of 8 x 8 pixels: at z = 10, x and y from -5 to 5, with its normal (0,
/// 0, -1) towards the camera.
inline Scene wall_scene(float tan_half = 0.25f) {
    Scene scene;
    const std::int32_t blue = add_diffuse(scene, {0.1f, 0.2f, 0.7f});
    Mesh wall = quad({-5, -5, 10}, {0, 10, 0}, {10, 0, 0});
    wall.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    add_shape(scene, wall, blue, Rgb(0.0f), "wall");
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    scene.camera = look_at(Vec3(0.0f), {0, 0, 1}, {0, 1, 0}, tan_half);
    set_film(scene, 8, 8);
    return scene;
}

inline constexpr const char* kFirstHitAovs =
    "albedo,normal,geometric_normal,depth,distance,position,uv,shape,material,alpha";

}  // namespace treefarm::test
