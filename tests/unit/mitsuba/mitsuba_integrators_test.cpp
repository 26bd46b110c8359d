// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Integrators and settings of the whole scene, held against the keys of a job.
class MitsubaIntegrators : public MitsubaFixture {
  protected:
    Job job_of(const LoadedScene& loaded) const {
        Job job;
        apply_layer(job, loaded.settings);
        return job;
    }
};

std::string property(const std::string& tag, const std::string& name, const std::string& value) {
    return "<" + tag + " name=\"" + name + "\" value=\"" + value + "\"/>";
}

std::string integrator(const std::string& type, const std::string& inside) {
    return "<integrator type=\"" + type + "\">" + inside + "</integrator>";
}

/// A property of Mitsuba, a value that its program takes, and what a key of the job becomes by it.
struct Mapped {
    const char *tag, *name, *value, *key, *expected;
};

/// Every parameter of the plugin (Tom94/practical-path-guiding, guided_path.cpp) and of the class below it.
constexpr Mapped kGuidedPath[] = {
    {"string", "nee", "never", "integrator.next_event", "never"},
    {"string", "nee", "kickstart", "integrator.next_event", "kickstart"},
    {"string", "nee", "always", "integrator.next_event", "always"},
    {"string", "sampleCombination", "discard", "guiding.combination", "last"},
    {"string", "sampleCombination", "automatic", "guiding.combination", "last"},
    {"string", "sampleCombination", "inversevar", "guiding.combination", "inverse_variance"},
    {"string", "spatialFilter", "nearest", "guiding.spatial_filter", "nearest"},
    {"string", "spatialFilter", "stochastic", "guiding.spatial_filter", "stochastic"},
    {"string", "spatialFilter", "box", "guiding.spatial_filter", "stochastic"},
    {"string", "directionalFilter", "nearest", "guiding.directional_filter", "nearest"},
    {"string", "directionalFilter", "box", "guiding.directional_filter", "box"},
    {"string", "bsdfSamplingFractionLoss", "none", "guiding.bsdf_fraction", "0.5"},
    {"string", "bsdfSamplingFractionLoss", "kl", "guiding.bsdf_fraction", "learned"},
    {"string", "bsdfSamplingFractionLoss", "var", "guiding.bsdf_fraction", "learned"},
    {"float", "bsdfSamplingFraction", "0.25", "guiding.bsdf_fraction", "0.25"},
    {"integer", "sTreeThreshold", "4000", "guiding.spatial_threshold", "4000"},
    {"float", "dTreeThreshold", "0.02", "guiding.directional_threshold", "0.02"},
    {"integer", "sppPerPass", "1", "guiding.spp_unit", "1"},
    {"float", "budget", "60", "budget.seconds", "60"},
    {"string", "budgetType", "seconds", "budget.seconds", "300"},
    {"string", "budgetType", "spp", "budget.spp", "300"},
    {"boolean", "doFilteredSplatting", "true", "guiding.directional_filter", "box"},
    {"boolean", "doFilteredSplatting", "false", "guiding.spatial_filter", "nearest"},
    {"boolean", "learnBsdfSamplingFraction", "true", "guiding.bsdf_fraction", "learned"},
    {"boolean", "automaticBudget", "true", "guiding.combination", "last"},
    {"boolean", "dumpSDTree", "true", "guiding.type", "ppg"},
    {"integer", "sdTreeMaxMemory", "100", "guiding.type", "ppg"},
};

/// Every parameter of a path tracer: Mitsuba's class MonteCarloIntegrator.
constexpr Mapped kPath[] = {
    {"integer", "maxDepth", "7", "integrator.max_depth", "7"},
    {"integer", "rrDepth", "3", "integrator.rr_depth", "3"},
    {"boolean", "strictNormals", "true", "integrator.strict_normals", "true"},
    {"boolean", "hideEmitters", "true", "integrator.hide_emitters", "true"},
};

/// Parameters of direct light: each number of samples, in 0.6 and 3 alike.
constexpr Mapped kDirect[] = {
    {"integer", "emitterSamples", "4", "integrator.emitter_samples", "4"},
    {"integer", "bsdfSamples", "0", "integrator.bsdf_samples", "0"},
    {"integer", "shadingSamples", "3", "integrator.emitter_samples", "3"},
    {"integer", "shadingSamples", "3", "integrator.bsdf_samples", "3"},
    {"boolean", "strictNormals", "true", "integrator.strict_normals", "true"},
    {"boolean", "hideEmitters", "true", "integrator.hide_emitters", "true"},
};

/// Parameters of ambient occlusion, of 0.6 alone.
constexpr Mapped kAmbientOcclusion[] = {
    {"integer", "shadingSamples", "3", "integrator.type", "ao"},
    {"float", "rayLength", "2.5", "integrator.ao_distance", "2.5"},
    {"float", "rayLength", "-1", "integrator.ao_distance", "0"},
};

/// Parameters of bidirectional path tracing that choose techniques.
constexpr Mapped kBidirectional[] = {
    {"boolean", "lightImage", "false", "bidirectional.light_image", "false"},
    {"boolean", "sampleDirect", "false", "integrator.next_event", "never"},
    {"boolean", "sampleDirect", "true", "integrator.next_event", "always"},
};

/// Parameters of every sampler.
constexpr Mapped kSampler[] = {
    {"integer", "sampleCount", "9", "budget.spp", "9"},
    {"integer", "seed", "7", "sampler.seed", "7"},
};

/// Parameters of the scene itself, in Mitsuba 3.
constexpr Mapped kScene[] = {
    {"boolean", "embree_use_robust_intersections", "true", "farm.robust", "true"},
};

/// Keys, or whole sections, that no parameter of Mitsuba's integrators, samplers and scenes stands for: how this
/// program works, or what it alone can do. The size of the image is the film's.
constexpr const char* kOwn[] = {
    "scene.",
    "image.",
    "effects.",
    "output.",
    "integrator.mis",
    "integrator.light_samples",
    "bidirectional.light_subpaths",
    "bidirectional.techniques",
    "bidirectional.weighted",
    "integrator.light_selection",
    "integrator.split_glass",
    "guiding.preset",
    "scene.root",
    "scene.max_file_mb",
    "scene.max_image_megapixels",
    "scene.max_triangles",
    "farm.checkpoint_seconds",
    "farm.leave_seconds",
    "guiding.bootstrap",
    "guiding.grid_halvings",
    "guiding.initial_model",
    "guiding.rule",
    "guiding.view_",
    "guiding.candidate",
    "guiding.target",
    "guiding.roulette",
    "guiding.splitting",
    "budget.error",
    "budget.max_spp",
    "budget.strict",
    "farm.tile_size",
    "farm.profile",
    "farm.heartbeat_seconds",
    "farm.update_seconds",
    "farm.isa",
    "farm.memory_check",
    "farm.join",
};

/// A key is a parameter's, which the reader maps, or our own: a new one has to be decided on.
TEST_F(MitsubaIntegrators, EveryKeyIsAParametersOrOurOwn) {
    std::set<std::string> mapped;
    for (const auto table :
         {std::span<const Mapped>(kGuidedPath), std::span<const Mapped>(kPath), std::span<const Mapped>(kDirect),
          std::span<const Mapped>(kAmbientOcclusion), std::span<const Mapped>(kBidirectional),
          std::span<const Mapped>(kSampler), std::span<const Mapped>(kScene)})
        for (const Mapped& row : table)
            mapped.insert(row.key);
    for (const JobKey& key : job_keys()) {
        const bool own = std::any_of(std::begin(kOwn), std::end(kOwn),
                                     [&](const char* prefix) { return key.name.starts_with(prefix); });
        EXPECT_NE(own, mapped.contains(key.name)) << key.name;
    }
    for (const Mapped& row : kSampler) {
        const auto loaded = load("<sensor type=\"perspective\"><sampler type=\"independent\">" +
                                 property(row.tag, row.name, row.value) + "</sampler></sensor>");
        EXPECT_EQ(find_job_key(row.key)->print(job_of(loaded)), row.expected) << row.name;
    }
    for (const Mapped& row : kScene) {
        const auto loaded = load_with_sensor(property(row.tag, row.name, row.value), "3.0.0");
        EXPECT_EQ(find_job_key(row.key)->print(job_of(loaded)), row.expected) << row.name;
    }
}

TEST_F(MitsubaIntegrators, WhatHasAKeyIsNotRefused) {
    const auto expect = [&](const Mapped& mapped, const char* type, const char* version) {
        // An emitter, since a scene of 0.6 without one gets a sky, which takes long to compute.
        const std::string body =
            integrator(type, property(mapped.tag, mapped.name, mapped.value)) + "<emitter type=\"point\"/>";
        ASSERT_EQ(refusal(body, version), "") << body;
        const JobKey* key = find_job_key(mapped.key);
        ASSERT_NE(key, nullptr) << mapped.key;
        EXPECT_EQ(key->print(job_of(load_with_sensor(body, version))), mapped.expected) << body;
    };
    for (const Mapped& mapped : kGuidedPath)
        expect(mapped, "guided_path", "0.6.0");
    for (const Mapped& mapped : kDirect)
        for (const char* version : {"0.6.0", "3.0.0"})
            expect(mapped, "direct", version);
    for (const Mapped& mapped : kAmbientOcclusion)
        expect(mapped, "ao", "0.6.0");
    for (const Mapped& mapped : kBidirectional)
        expect(mapped, "bdpt", "0.6.0");
    for (const Mapped& mapped : kPath)
        for (const char* type : {"path", "volpath", "guided_path", "bdpt"})
            for (const char* version : {"0.6.0", "3.0.0"})
                expect(mapped, type, version);
}

TEST_F(MitsubaIntegrators, WholeScene) {
    const auto robust = [&](const std::string& value) {
        return job_of(load_with_sensor(property("boolean", "embree_use_robust_intersections", value), "3.0.0"))
            .farm.robust;
    };
    EXPECT_TRUE(robust("true"));
    EXPECT_FALSE(robust("false"));
}

/// Each number of direct light is its own, whatever shadingSamples says; and the estimator is the scene's.
TEST_F(MitsubaIntegrators, DirectLight) {
    for (const bool first : {true, false}) {
        const std::string both = property("integer", "shadingSamples", "5"),
                          one = property("integer", "bsdfSamples", "2");
        const Job job = job_of(load_with_sensor(integrator("direct", first ? both + one : one + both)));
        EXPECT_EQ(job.integrator.type, "direct");
        EXPECT_EQ(job.integrator.emitter_samples, 5);
        EXPECT_EQ(job.integrator.bsdf_samples, 2);
    }
    EXPECT_EQ(job_of(load_with_sensor(integrator("direct", ""))).integrator.emitter_samples, 1);
    EXPECT_THROW(job_of(load_with_sensor(integrator("direct", property("integer", "bsdfSamples", "-1")))), InputError);
    EXPECT_NE(refusal(integrator("ao", property("float", "rayLength", "0")), "0.6.0"), "");
}

TEST_F(MitsubaIntegrators, LightTracing) {
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const std::string depth = property("integer", version[0] == '0' ? "maxDepth" : "max_depth", "7");
        const Job job = job_of(load_with_sensor(integrator("ptracer", depth), version));
        EXPECT_EQ(job.integrator.type, "light");
        EXPECT_EQ(job.integrator.max_depth, 7);
    }
    const std::string granularity =
        property("integer", "granularity", "1000") + property("boolean", "bruteForce", "true");
    EXPECT_EQ(refusal(integrator("ptracer", granularity), "0.6.0"), "");
}

TEST_F(MitsubaIntegrators, FromBothEnds) {
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const Job job = job_of(load_with_sensor(integrator("bdpt", ""), version));
        EXPECT_EQ(job.integrator.type, "bidirectional");
        EXPECT_TRUE(job.bidirectional.light_image);
        EXPECT_NE(job.integrator.next_event, NextEvent::never);
    }
}

/// A way to transport light leaves guiding to the job, and the log says so.
TEST_F(MitsubaIntegrators, PathSaysNothingOfGuiding) {
    for (const char* type : {"path", "volpath"}) {
        const auto loaded = load_with_sensor(integrator(type, ""));
        EXPECT_EQ(job_of(loaded).guiding.type, Job().guiding.type) << type;
        EXPECT_TRUE(std::none_of(loaded.settings.begin(), loaded.settings.end(),
                                 [](const Setting& s) { return s.key.starts_with("guiding."); }));
        ASSERT_EQ(loaded.notes.size(), 1u) << type;
        EXPECT_NE(loaded.notes[0].text().find("guiding.type"), std::string::npos);
    }
}

/// A job's budget wins over the scene's seconds, which would make it void.
TEST_F(MitsubaIntegrators, BudgetOfTheJobWins) {
    const auto loaded = load_with_sensor(integrator("guided_path", property("float", "budget", "60")));
    const std::vector<Setting> asked{{"budget.spp", "8", {}}}, other{{"sampler.seed", "1", {}}};
    Job job;
    apply_layer(job, scene_layer(loaded.settings, {asked}));
    EXPECT_EQ(job.budget.seconds, 0.0);
    apply_layer(job, scene_layer(loaded.settings, {other}));
    EXPECT_EQ(job.budget.seconds, 60.0);
}

TEST_F(MitsubaIntegrators, ForksKeepWhatAllHaveWhenLenient) {
    const std::string body =
        integrator("my_path", property("integer", "maxDepth", "7") + property("integer", "rrDepth", "3") +
                                  property("boolean", "strictNormals", "true") +
                                  property("boolean", "hideEmitters", "true") + property("float", "magic", "3"));
    EXPECT_NE(refusal(body, "0.6.0"), "");
    for (const char* version : {"0.6.0", "3.0.0"}) {
        const Job job = job_of(load("<sensor type=\"perspective\"/>" + body, version, {}, true));
        EXPECT_EQ(job.integrator.max_depth, 7);
        EXPECT_EQ(job.integrator.rr_depth, 3);
        EXPECT_TRUE(job.integrator.strict_normals);
        EXPECT_TRUE(job.integrator.hide_emitters);
    }
}

TEST_F(MitsubaIntegrators, AovsBecomeLayersByTheirNames) {
    const std::string inner = integrator("path", property("integer", "max_depth", "7"));
    const Job job = job_of(load_with_sensor(
        integrator("aov", property("string", "aovs", "dd.y:depth, nn:sh_normal,id:shape_index") + inner), "3.0.0"));
    EXPECT_EQ(job.output.aovs, "dd.y:distance,nn:normal,id:shape") << "Mitsuba's depth is the ray's length";
    EXPECT_EQ(job.integrator.max_depth, 7);
    EXPECT_EQ(job_of(load_with_sensor(integrator("aov", property("string", "aovs", "a:albedo")), "3.0.0")).output.aovs,
              "a:albedo");
    const std::string unknown = integrator("aov", property("string", "aovs", "a:albedo,b:boundary_test") + inner);
    EXPECT_NE(refusal(unknown, "3.0.0").find("boundary_test"), std::string::npos);
    const LoadedScene lenient = load("<sensor type=\"perspective\"/>" + unknown, "3.0.0", {}, true);
    EXPECT_EQ(job_of(lenient).output.aovs, "a:albedo");
    EXPECT_NE(refusal(integrator("aov", property("string", "aovs", "albedo") + inner), "3.0.0").find("NAME:VARIABLE"),
              std::string::npos);
}

TEST_F(MitsubaIntegrators, AFormatWithAlphaAsksForIt) {
    const auto aovs = [&](const std::string& format, const std::string& more) {
        return job_of(load("<sensor type=\"perspective\"><film type=\"hdrfilm\">" +
                               property("string", "pixelFormat", format) + "</film></sensor>\n" + more,
                           "0.6.0"))
            .output.aovs;
    };
    EXPECT_EQ(aovs("rgba", ""), "alpha");
    EXPECT_EQ(aovs("luminanceAlpha", ""), "alpha");
    EXPECT_EQ(aovs("rgb", ""), "");
    EXPECT_EQ(aovs("rgba", integrator("aov", property("string", "aovs", "a:albedo"))), "alpha,a:albedo");
}

}  // namespace
}  // namespace treefarm
