// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/config/effect_switches.h"
#include "common/config/job_reader.h"
#include "common/guiding/statistics/cell_sums.h"
#include "common/plan/effects/effect_table.h"
#include "common/plan/effects/plan_text.h"
#include "common/plan/schedule/learning.h"
#include "common/scene/uses/material_traits.h"
#include "common/scene/uses/texture_mean.h"
#include "tests/support/refusal.h"
#include "tests/support/resolved.h"

namespace treefarm {
namespace {

Location line(int n) {
    return {"scene.xml", n, 1};
}

BitmapTexture bitmap(std::int32_t image) {
    BitmapTexture texture;
    texture.image = image;
    return texture;
}

CheckerboardTexture squares(float color0, float color1) {
    CheckerboardTexture texture;
    texture.color0 = Rgb(color0);
    texture.color1 = Rgb(color1);
    return texture;
}

DielectricMaterial dielectric(float eta) {
    DielectricMaterial material;
    material.eta = eta;
    return material;
}

/// One of every effect that a job can force off, and some that it cannot.
Scene full_scene() {
    Scene scene;
    scene.film.width = 40;
    scene.film.height = 30;
    for (const float value : {0.25f, 0.75f, 1.0f}) {  // an image per user: colour, environment, normals
        TextureImage image;
        image.width = image.height = 2;
        image.floats.assign(12, value);
        scene.images.push_back(image);
    }
    scene.textures.push_back({bitmap(0), "colour", line(1)});
    scene.textures.push_back({squares(0.0f, 1.0f), "opacity", line(2)});
    scene.textures.push_back({bitmap(2), "normals", line(3)});
    scene.textures.push_back({squares(0.4f, 0.2f), "unused", line(4)});
    scene.textures.push_back({squares(2.0f, 4.0f), "radiance", line(5)});
    const auto add = [&](auto bsdf, int at) -> Material& {
        Material material;
        material.bsdf = bsdf;
        material.where = line(at);
        scene.materials.push_back(material);
        Shape shape;
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
        mesh.indices = {0, 1, 2};
        shape.geometry = mesh;
        shape.material = static_cast<std::int32_t>(scene.materials.size() - 1);
        scene.shapes.push_back(shape);
        return scene.materials.back();
    };
    add(DiffuseMaterial{{Rgb(0.5f), 0}}, 10);
    add(DiffuseMaterial{Rgb(0.4f)}, 11).opacity = {1.0f, 1};
    add(DiffuseMaterial{Rgb(0.4f)}, 12).detail.bump = 1;
    add(DiffuseMaterial{Rgb(0.4f)}, 13).detail.normal_map = 2;
    add(dielectric(0.5f), 14);
    add(ThinDielectricMaterial{}, 15);
    add(ConductorMaterial{.roughness = {Microfacets::ggx, {0.1f}, {0.4f}}}, 16);
    scene.emitters.push_back({PointEmitter{}, line(20)});
    scene.emitters.push_back({EnvironmentEmitter{.image = 1}, line(21)});
    scene.emitters.push_back({AreaEmitter{{Rgb(1.0f), 4}, 2}, line(22)});
    scene.shapes[2].emitter = 2;
    scene.camera.lens_u = {0.1f, 0, 0};
    scene.camera.lens_v = {0, 0.1f, 0};
    return scene;
}

Job job_without(const std::vector<std::string>& effects) {
    Job job;
    for (const std::string& effect : effects)
        apply_setting(job, kEffectsPrefix + effect, "false", {});
    return job;
}

std::vector<std::string> all_switches() {
    std::vector<std::string> names;
    for (const EffectSwitch& effect : effect_switches())
        names.push_back(effect.name);
    return names;
}

TEST(Plan, EverySwitchTurnsOffWhatItNamesAndNothingElse) {
    for (const std::string& effect : all_switches()) {
        Scene asked = full_scene(), scene = full_scene();
        const EffectPlan before = plan_effects(asked, Job{});
        const EffectPlan after = plan_effects(scene, job_without({effect}));
        EXPECT_TRUE(before.approximations.empty());
        ASSERT_TRUE(before.find(effect)) << effect;
        EXPECT_TRUE(before.find(effect)->on) << effect;
        EXPECT_FALSE(after.find(effect)->on) << effect;
        EXPECT_EQ(after.find(effect)->bytes, 0u) << effect;
        EXPECT_NE(after.find(effect)->reason.find("effects." + effect + " = false"), std::string::npos)
            << after.find(effect)->reason;
        EXPECT_EQ(after.find(effect)->where.text(), before.find(effect)->where.text());
        ASSERT_EQ(after.approximations.size(), 1u) << effect;
        EXPECT_EQ(after.approximations[0].effect, effect);
        for (const std::string& other : all_switches())
            if (other != effect) {
                EXPECT_TRUE(after.find(other)->on) << other << " without " << effect;
            }
    }
}

TEST(Plan, WhatIsForcedOffLeavesTheScene) {
    Scene scene = full_scene();
    const EffectPlan plan = plan_effects(scene, job_without(all_switches()));
    EXPECT_EQ(plan.approximations.size(), effect_switches().size());
    EXPECT_TRUE(scene.textures.empty());
    EXPECT_TRUE(scene.images.empty());
    for (const Shape& shape : scene.shapes)
        EXPECT_TRUE(std::get<Mesh>(shape.geometry).uvs.empty());
    EXPECT_FALSE(scene.camera.has_lens());
    ASSERT_EQ(scene.emitters.size(), 1u);
    EXPECT_EQ(scene.shapes[2].emitter, 0);
    EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).radiance, ColorInput(Rgb(3.0f)));
    const MaterialTraits traits = scene_traits(scene);
    EXPECT_FALSE(traits.lobes.transmits() || traits.needs_surface_detail() || traits.masked);
    EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[0].bsdf).reflectance, ColorInput(Rgb(0.125f)));
    EXPECT_FLOAT_EQ(std::get<PlasticMaterial>(scene.materials[4].bsdf).eta, 2.0f);
    EXPECT_FLOAT_EQ(std::get<ConductorMaterial>(scene.materials[6].bsdf).roughness.alpha_v.value, 0.2f);
}

TEST(Plan, WhatNothingUsesIsNotKeptAndIndicesFollow) {
    Scene scene = full_scene();
    plan_effects(scene, job_without({"textures"}));
    ASSERT_EQ(scene.textures.size(), 3u);  // neither the colour's nor the unused one
    EXPECT_EQ(scene.textures[std::size_t(scene.materials[3].detail.normal_map)].name, "normals");
    EXPECT_EQ(scene.textures[std::size_t(scene.materials[1].opacity.texture)].name, "opacity");
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[std::size_t(std::get<EnvironmentEmitter>(scene.emitters[1].kind).image)].floats[0], 0.75f);
    EXPECT_TRUE(std::get<Mesh>(scene.shapes[0].geometry).uvs.empty());
    EXPECT_FALSE(std::get<Mesh>(scene.shapes[1].geometry).uvs.empty()) << "its mask is looked up";
    EXPECT_FALSE(std::get<Mesh>(scene.shapes[3].geometry).uvs.empty()) << "its normals are looked up";
}

TEST(Plan, ASwitchThatTheSceneDoesNotNeedIsNoApproximation) {
    Scene scene;
    const EffectPlan plan = plan_effects(scene, job_without(all_switches()));
    EXPECT_TRUE(plan.approximations.empty());
    EXPECT_EQ(plan.find("bump")->reason, "nothing in the scene calls for it");
}

TEST(Plan, KindsGoOffWithTheirGroupAndSaySo) {
    Scene scene = full_scene();
    const EffectPlan plan = plan_effects(scene, job_without({"delta_lights"}));
    EXPECT_FALSE(plan.find("point")->on);
    EXPECT_NE(plan.find("point")->reason.find("effects.delta_lights"), std::string::npos);
    EXPECT_EQ(plan.find("point")->where.text(), line(20).text());
}

TEST(Plan, ListsEveryEffectOnceWithAReason) {
    const EffectPlan plan = [] {
        Scene scene = full_scene();
        return plan_effects(scene, Job{});
    }();
    std::set<std::string> names;
    for (const Effect& effect : plan.effects) {
        EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
        EXPECT_FALSE(effect.reason.empty()) << effect.name;
        if (!effect.on) {
            EXPECT_EQ(effect.bytes, 0u) << effect.name;
        }
        if (effect.group == "never") {
            EXPECT_FALSE(effect.on);
        }
    }
    EXPECT_EQ(names.size(), effect_table().size());
    // Each has a switch, or a message that says what to do instead.
    for (const EffectSwitch& effect : effect_switches())
        EXPECT_EQ(names.erase(effect.name), 1u) << effect.name;
    for (const auto& [name, cure] : effects_without_switch())
        EXPECT_EQ(names.erase(name), 1u) << name;
    EXPECT_TRUE(names.empty()) << *names.begin();
}

TEST(Plan, TheJobDecidesAboutTransport) {
    Scene scene = full_scene();
    Job job;
    job.guiding.type = GuidingType::none;
    job.integrator.next_event = NextEvent::never;
    job.integrator.max_depth = 5;
    job.integrator.strict_normals = true;
    const EffectPlan plan = plan_effects(scene, job);
    for (const char* name : {"guiding", "recording", "next_event", "mis", "kickstart", "roulette"})
        EXPECT_FALSE(plan.find(name)->on) << name;
    EXPECT_TRUE(plan.find("strict_normals")->on && plan.find("depth_limit")->on);
    ASSERT_EQ(plan.kernels.size(), 1u);
    EXPECT_EQ(plan.kernels[0].kernel.name(), "general");
    EXPECT_TRUE(plan.warnings.empty());
}

TEST(Plan, SaysWhatPathsFromEmittersTake) {
    Scene scene = full_scene();
    Job job;
    const auto found = [&](const char* name) { return *plan_effects(scene, job).find(name); };
    for (const char* name : {"light_subpaths", "light_image", "connections"})
        EXPECT_FALSE(found(name).on) << name;
    EXPECT_EQ(found("light_subpaths").reason, "integrator.type = \"path\"");

    job.integrator.type = "light";
    EXPECT_TRUE(found("light_subpaths").on && found("light_image").on);
    EXPECT_FALSE(found("connections").on);

    job.integrator.type = "bidirectional";
    EXPECT_TRUE(found("light_subpaths").on && found("light_image").on && found("connections").on);
    EXPECT_EQ(found("light_image").bytes, 2u * 96 * scene.film.pixel_count());
    EXPECT_EQ(found("light_image").bytes, splat_bytes(scene, resolve(job, scene)));
    job.bidirectional.light_image = false;
    EXPECT_EQ(found("light_image").reason, "bidirectional.light_image = false");

    scene.emitters.clear();
    for (const char* name : {"light_subpaths", "light_image", "connections"})
        EXPECT_FALSE(found(name).on) << name;
}

TEST(Plan, NamesTheKernelOfEachPass) {
    const Scene scene;
    Job job;
    job.guiding.spp_unit = 4;
    job.budget.spp = 28;  // 4 + 8 + 16
    const std::vector<KernelUse> kernels = kernels_of(resolve(job, scene));
    ASSERT_EQ(kernels.size(), 3u);
    EXPECT_EQ(kernels[0].kernel.name(), "diffuse, recording");
    EXPECT_EQ(kernels[2].kernel.name(), "diffuse, guided");
    EXPECT_EQ(kernels[2].passes, (std::vector<std::uint32_t>{2}));
    EXPECT_EQ(kernels[1].kernel.name(), "diffuse, guided, recording");
    EXPECT_EQ(kernels_of(resolve(job, full_scene()))[1].kernel.name(), "general, guided, by view, recording");
    job.guiding.type = GuidingType::ppg;
    EXPECT_EQ(kernels_of(resolve(job, full_scene()))[1].kernel.name(), "general, guided, recording");
}

TEST(Plan, MemoryFollowsTheFormulas) {
    Scene scene = full_scene();
    const MemoryPlan plan = expected_memory(scene, resolve(Job{}, scene));
    std::uint64_t sum = 0;
    for (const MemoryItem& item : plan.worker)
        sum += item.bytes;
    EXPECT_EQ(sum, plan.worker_bytes());
    EXPECT_EQ(mesh_bytes(std::get<Mesh>(scene.shapes[0].geometry)), 3u * 12 + 3 * 8 + 3 * 4);
    EXPECT_EQ(image_bytes(scene.images[0]), 48u);
    Job unguided;
    unguided.guiding.type = GuidingType::none;
    EXPECT_EQ(expected_tree(scene, resolve(unguided, scene)).cells, 0u);
    scene.film.width = scene.film.height = 1000;
    EXPECT_GT(expected_tree(scene, resolve(Job{}, scene)).regions, 1000u);
    const TreeSize learned{10, 200, true}, fixed{10, 200, false};
    EXPECT_EQ(learned.sum_bytes() - fixed.sum_bytes(), 10u * kMixtureBins * 8);
    TreeSize deciding = fixed;
    deciding.with_next_event = true;
    EXPECT_EQ(deciding.sum_bytes() - fixed.sum_bytes(), 10u * (1 + 8 * kNextEventSums));
    EXPECT_EQ(deciding.guide_bytes() - fixed.guide_bytes(), 10u);
    EXPECT_TRUE(expected_tree(scene, resolve(Job{}, scene)).with_next_event);
    EXPECT_TRUE(expected_tree(scene, resolve(Job{}, scene)).with_mixture);
    Job given;
    given.guiding.learn_bsdf_fraction = false;
    EXPECT_FALSE(expected_tree(scene, resolve(given, scene)).with_mixture);
}

/// Images of passes were all kept: 200 of 3840 x 2160 pixels were 186 GB.
TEST(Plan, TheFilmDoesNotGrowWithThePasses) {
    Scene scene = full_scene();
    scene.film.width = 3840;
    scene.film.height = 2160;
    const std::uint64_t pixels = scene.film.pixel_count();
    const auto film = [&](const Job& job) { return expected_memory(scene, resolve(job, scene)).coordinator[1]; };
    Job job;
    job.guiding.spp_unit = 1;
    job.budget.spp = (1u << 8) - 1;
    const std::uint64_t of_eight = pixels * (8 * 112 + 2 * 96 + 2 * 48 + 8), merged = of_eight + 112 * pixels;
    EXPECT_EQ(plan_passes(resolve(job, scene)).size(), 8u);
    EXPECT_EQ(film(job).bytes, of_eight);
    EXPECT_NE(film(job).formula.find(", 8 passes"), std::string::npos);
    job.budget.spp = (1u << 20) - 1;
    EXPECT_EQ(film(job).bytes, merged);
    EXPECT_NE(film(job).formula.find("20 passes merged into 8"), std::string::npos) << film(job).formula;
    job.budget.seconds = 3600;  // nobody knows how many
    EXPECT_EQ(film(job).bytes, merged);
    job.budget.strict = true;
    EXPECT_EQ(film(job).bytes, merged - 7 * 112 * pixels);
}

TEST(RefineSettings, ATreeIsTheLastWhereItsPassSaysSo) {
    PassPlan coming;
    coming.record = true;
    EXPECT_FALSE(refine_settings(test::resolved(Job()), {}, coming).last_update);
    coming.last_tree = true;
    EXPECT_TRUE(refine_settings(test::resolved(Job()), {}, coming).last_update) << "also where it teaches again";
    EXPECT_TRUE(make_pass(test::resolved(Job()), 3, 7, 8, true).last_tree);
    EXPECT_FALSE(make_pass(test::resolved(Job()), 3, 7, 8, false).last_tree);
}

TEST(Plan, CellsFollowUseWhereViewsAndMixturesAreLearned) {
    const auto least_use = [](Job job) { return refine_settings(test::resolved(job), {}, {}).least_use; };
    Job job;
    EXPECT_EQ(least_use(job), 0.5);
    job.guiding.type = GuidingType::ppg;
    EXPECT_EQ(least_use(job), 1.0);
    job.guiding.type = GuidingType::view;
    EXPECT_EQ(least_use(job), 0.5);
    job.guiding.learn_bsdf_fraction = false;
    EXPECT_EQ(least_use(job), 1.0);
    job.guiding.learn_bsdf_fraction = true;
    job.guiding.view_records = ViewRecords::radiance;  // as published
    EXPECT_EQ(least_use(job), 1.0);

    const Scene scene = full_scene();
    Job ppg;
    ppg.guiding.type = GuidingType::ppg;
    const TreeSize even = expected_tree(scene, resolve(ppg, scene)),
                   by_use = expected_tree(scene, resolve(Job{}, scene));
    ASSERT_EQ(even.regions, by_use.regions);
    EXPECT_LT(by_use.cells - by_use.views * 240, even.cells);
}

TEST(Plan, TextAndJsonSayTheSame) {
    Scene scene = full_scene();
    const EffectPlan plan = plan_effects(scene, job_without({"bump", "lens"}));
    const std::string text = plan_text(plan, "scene.xml");
    const nlohmann::json json = nlohmann::json::parse(plan_json(plan, "scene.xml"));
    EXPECT_LT(text.find("effects on"), text.find("effects off"));
    ASSERT_EQ(json["effects"].size(), plan.effects.size());
    for (const auto& effect : json["effects"]) {
        EXPECT_NE(text.find(effect["name"].get<std::string>()), std::string::npos);
        EXPECT_EQ(effect["simulated"].get<bool>(), effect["group"] != "never");
    }
    EXPECT_EQ(json["approximations"].size(), 2u);
    EXPECT_EQ(json["approximations"][0]["effect"], "bump");
    EXPECT_EQ(json["approximations"][0]["where"]["line"], 12);
    EXPECT_TRUE(json["approximations"][1]["where"].is_null()) << "the lens is the sensor's";
    EXPECT_EQ(json["memory"]["worker"]["bytes"].get<std::uint64_t>(), plan.memory.worker_bytes());
    EXPECT_NE(text.find("bump is off for 1 place in the scene (scene.xml:12:1)"), std::string::npos);
    EXPECT_EQ(bytes_text(1023), "1023 bytes");
    EXPECT_EQ(bytes_text(1536), "1.5 KiB");
    EXPECT_EQ(bytes_text(std::uint64_t{300} << 20), "300 MiB");
}

TEST(EffectKeys, AreCheckedAndSurviveJobToml) {
    Job job = job_without({"bump", "masks"});
    Job again;
    apply_layer(again, parse_job_settings(write_job(job), "job.toml"));
    EXPECT_EQ(again.effects.off, job.effects.off);
    apply_setting(again, "effects.bump", "auto", {});
    EXPECT_EQ(again.effects.off, std::set<std::string>{"masks"});
    const auto message = [](const std::string& toml) -> std::string {
        return test::refusal_of([&] {
            Job target;
            apply_layer(target, parse_job_settings(toml, "job.toml"));
        });
    };
    EXPECT_EQ(message("[effects]\nbump = false\n"), "");
    EXPECT_NE(message("[effects]\nbump = true\n").find("job.toml:2:8: effects.bump cannot be forced on"),
              std::string::npos);
    EXPECT_NE(message("[effects]\nbumb = false\n").find("did you mean effects.bump?"), std::string::npos);
    EXPECT_NE(message("[effects]\nbump = 0\n").find("is an integer"), std::string::npos);
    EXPECT_NE(message("[effects]\nguiding = false\n").find("guiding.type"), std::string::npos);
    EXPECT_NE(message("[effects]\nmedia = true\n").find("never simulated"), std::string::npos);
}

}  // namespace
}  // namespace treefarm
