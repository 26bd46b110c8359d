// SPDX-License-Identifier: Apache-2.0
// Estimators against what is known exactly, and the lists of them against each other.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "common/base/error.h"
#include "common/config/check_job.h"
#include "common/config/estimators.h"
#include "common/config/job_keys.h"
#include "common/config/techniques.h"
#include "common/plan/effects/effects.h"
#include "common/plan/effects/plan_text.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "tests/support/guide_types.h"
#include "tests/support/local_render.h"
#include "tests/support/test_scenes.h"
#include "worker/registry.h"

namespace treefarm {
namespace {

Job job_of(const std::string& type, std::uint32_t spp = 64) {
    Job job;
    job.integrator.type = type;
    job.budget.spp = spp;
    job.sampler.seed = 9;
    return job;
}

/// A floor of 20 x 20 about the origin, its front up, seen from above: every pixel sees nearly the origin.
Scene floor_from_above(float albedo = 0.5f) {
    Scene scene;
    test::add_shape(scene, test::quad({-10, 0, -10}, {0, 0, 20}, {20, 0, 0}), test::add_diffuse(scene, Rgb(albedo)));
    scene.camera = test::look_at({0.4f, 0.5f, 0.0f}, Vec3(0.0f), {0, 0, 1}, 1e-4f);
    test::set_film(scene, 8, 8);
    return scene;
}

/// Mean of all pixels of the last pass, and its standard error.
struct Mean {
    Rgb64 value{0.0};
    double error = 0;
};

Mean mean_of(const test::LocalRender& run) {
    Moments all;
    for (const PixelEstimate& pixel : run.passes.back().pixels)
        all = Moments::merge(all, pixel.whole());
    return {all.mean, std::sqrt(all.sample_variance().x / all.n)};
}

void expect_mean(const Scene& scene, const Job& job, double exact, const std::string& what) {
    const Mean mean = mean_of(test::render_locally(scene, job));
    EXPECT_NEAR(mean.value.x, exact, 4.5 * mean.error + 1e-3 * exact) << what;
    EXPECT_LT(mean.error, 0.05) << what << ": nothing was tested";
}

void expect_same_pixels(const test::LocalRender& a, const test::LocalRender& b) {
    ASSERT_EQ(a.passes.size(), b.passes.size());
    for (std::size_t k = 0; k < a.passes.size(); ++k)
        for (std::size_t p = 0; p < a.passes[k].pixels.size(); ++p)
            ASSERT_EQ(a.passes[k].pixels[p].whole().mean, b.passes[k].pixels[p].whole().mean) << "pixel " << p;
}

TEST(Estimators, OfJobsAndWorkersAreTheSame) {
    ASSERT_EQ(integrators().size(), estimators().size());
    for (std::size_t i = 0; i < estimators().size(); ++i)
        EXPECT_STREQ(integrators()[i].type, estimators()[i].type);
    EXPECT_EQ(find_estimator("nonsense"), nullptr);
    EXPECT_THROW(integrator_of("nonsense"), RunError);
    EXPECT_EQ(Job().integrator.type, estimators()[0].type) << "the usual one comes first";
}

/// What a pass does not use, its plan does not have.
TEST(Estimators, UnguidedOnesLearnNothing) {
    for (const Estimator& estimator : estimators()) {
        if (estimator.guides) continue;
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        const Resolved job = resolve(job_of(estimator.type), scene);
        EXPECT_FALSE(job.guides || job.learns_lights || job.learns_views || job.cells_follow_use) << estimator.type;
        EXPECT_FALSE(job.integrator.split_glass) << estimator.type;
        for (const PassPlan& pass : plan_passes(job)) {
            EXPECT_FALSE(pass.record || pass.guided) << estimator.type;
            EXPECT_TRUE(estimator.sees_light || !pass.next_event) << estimator.type;
        }
        EXPECT_NE(plan_text(plan_effects(scene, job_of(estimator.type)), "s.xml")
                      .find(std::string("\nestimator: ") + estimator.type + "\n"),
                  std::string::npos);
        for (const GuidingType type : {GuidingType::ppg, GuidingType::view}) {
            Job asked = job_of(estimator.type);
            asked.guiding.type = type;
            EXPECT_THROW(check_job(asked), InputError) << estimator.type;
        }
        EXPECT_NO_THROW(check_job(job_of(estimator.type)));
        EXPECT_NO_THROW(check_job(job));
    }
}

/// What an estimator cannot find, or sum up, is said before it renders.
TEST(Estimators, SayWhatTheyMissAndRefuse) {
    for (const Estimator& estimator : estimators()) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        const std::string text = plan_text(plan_effects(scene, job_of(estimator.type)), "s.xml");
        if (estimator.misses) {
            EXPECT_NE(text.find(estimator.misses), std::string::npos) << text;
        }
        scene.film.filter = PixelFilter::lanczos;
        scene.film.filter_radius = 3.0f;
        if (!estimator.splats()) {
            EXPECT_NO_THROW(plan_effects(scene, job_of(estimator.type))) << estimator.type;
            continue;
        }
        EXPECT_EQ(estimator.misses == nullptr, estimator.has_camera_paths()) << estimator.type;
        try {
            plan_effects(scene, job_of(estimator.type));
            ADD_FAILURE() << estimator.type << " took a filter with negative lobes";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("box, tent or gaussian"), std::string::npos) << error.what();
        }
    }
}

/// Light of a point that comes over a mirror is not found by every estimator: said where there are both.
TEST(Estimators, SayWhatTheyMissOfPoints) {
    for (const Estimator& estimator : estimators())
        for (const bool point : {false, true})
            for (const bool mirror : {false, true}) {
                Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
                if (point) scene.emitters.push_back({PointEmitter{{0.5f, 0.8f, 0.0f}, Rgb(3.0f)}, {}});
                if (mirror) scene.materials[0].bsdf = ConductorMaterial{};
                const EffectPlan plan = plan_effects(scene, job_of(estimator.type));
                const bool missed = point && mirror && estimator.misses_of_points;
                EXPECT_EQ(plan.misses.size(), (missed ? 1u : 0u) + (estimator.misses ? 1u : 0u)) << estimator.type;
                if (missed) {
                    EXPECT_NE(plan_text(plan, "s.xml").find(estimator.misses_of_points), std::string::npos);
                    EXPECT_NE(plan_json(plan, "s.xml").find(estimator.misses_of_points), std::string::npos);
                }
            }
}

TEST(Techniques, AreReadAndRefused) {
    const JobKey& key = *find_job_key("bidirectional.techniques");
    Job job;
    for (const auto& [text, canonical] : {std::pair("all", "all"), {" 0,3   1,2 0,3", "0,3 1,2"}, {"2,1", "2,1"}}) {
        EXPECT_TRUE(key.parse(job, text)) << text;
        EXPECT_EQ(key.print(job), canonical);
    }
    for (const char* text : {"", "1,1", "0,1", "2,0", "-1,3", "1", "1;2", "1,2,3", "a,b", "1,2 all", "0,1001"}) {
        EXPECT_FALSE(key.parse(job, text)) << text;
        EXPECT_NE(key.refusal(text), "") << text;
        EXPECT_EQ(key.print(job), "2,1") << text;
    }
    const TechniqueSet all("all"), two("0,3 1,2");
    EXPECT_TRUE(all.has(7, 9) && two.has(0, 3) && two.has(1, 2));
    EXPECT_FALSE(two.has(3, 0) || two.has(2, 1) || two.has(0, 2));
}

/// Without weights light counts once only if nobody else finds it; equal weights are those of the worst technique.
TEST(Techniques, ThatCountLightTwiceAreRefused) {
    for (const auto& [techniques, allowed] :
         {std::pair("all", false), {"0,3 1,2", false}, {"1,2", true}, {"0,2 1,2 1,3", true}}) {
        Job job = job_of("bidirectional");
        job.bidirectional.techniques = techniques;
        EXPECT_NO_THROW(check_job(job));
        job.bidirectional.weighted = false;
        if (allowed)
            EXPECT_NO_THROW(check_job(job)) << techniques;
        else
            EXPECT_THROW(check_job(job), InputError) << techniques;
        job.integrator.type = "path";
        EXPECT_NO_THROW(check_job(job)) << "it is another estimator's";
    }
    Job job = job_of("bidirectional");
    job.integrator.mis = MisHeuristic::equal;
    EXPECT_THROW(check_job(job), InputError);
    job = job_of("bidirectional");
    job.bidirectional.techniques = "1,2 2,1";
    EXPECT_NO_THROW(check_job(job));
    job.bidirectional.light_image = false;
    EXPECT_THROW(check_job(job), InputError) << "2,1 would be black";
}

/// Whether a file may name estimators and guides as scenes do: it reads scenes.
bool is_of_the_input_side(const std::filesystem::path& file) {
    return file.string().find("/coordinator/input/") != std::string::npos;
}

/// The coordinator plans passes and adds up films, whatever renders them. A study's "reference" is an image.
TEST(Estimators, TheCoordinatorNamesNone) {
    const std::filesystem::path module = std::filesystem::path(TREEFARM_SOURCE_DIR) / "coordinator";
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(module)) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        if (is_of_the_input_side(entry.path())) continue;
        ++files;
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const bool study = entry.path().parent_path().filename() == "study";
        for (const Estimator& estimator : estimators()) {
            if (study && std::string(estimator.type) == "reference") continue;
            EXPECT_EQ(text.find('"' + std::string(estimator.type) + '"'), std::string::npos)
                << entry.path() << " names " << estimator.type;
        }
        EXPECT_EQ(text.find("integrator.type"), std::string::npos) << entry.path();
    }
    EXPECT_GT(files, 20u);
}

/// Words of a program, without its comments.
std::set<std::string> identifiers(const std::string& text) {
    std::set<std::string> words;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::string word;
        for (const char c : line.substr(0, line.find("//")) + " ") {
            if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
                word += c;
            } else {
                words.insert(word);
                word.clear();
            }
        }
    }
    return words;
}

/// Nor does it name a guide, its kind, cells or codes; integrators do not either.
TEST(Guides, CoordinatorAndIntegratorsNameNone) {
    const std::filesystem::path root(TREEFARM_SOURCE_DIR);
    std::vector<std::string> names = {"SdTree", "sd_tree", "GuideKind::", "GuidingType::"};
    for (const std::string& type : test::guide_types())
        if (type != "auto") names.push_back('"' + type + '"');
    const std::set<std::string> parts = {"code",          "codes", "code_", "codes_",   "cell",
                                         "cells",         "view",  "views", "quadtree", "direction_to_code",
                                         "square_to_code"};
    std::vector<std::filesystem::path> files = {root / "worker/registry.h", root / "worker/registry.cpp"};
    for (const char* module : {"coordinator", "worker/integrators"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / module))
            if ((entry.path().extension() == ".h" || entry.path().extension() == ".cpp") &&
                !is_of_the_input_side(entry.path()))
                files.push_back(entry.path());
    for (const std::filesystem::path& name : files) {
        std::ifstream file(name);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        for (const std::string& guide : names)
            EXPECT_EQ(text.find(guide), std::string::npos) << name << " names " << guide;
        if (name.string().find("/coordinator/") != std::string::npos) continue;
        for (const std::string& word : identifiers(text))
            EXPECT_EQ(parts.count(word), 0u) << name << " names a guide's " << word;
    }
    EXPECT_GT(files.size(), 60u);
}

/// A message may bring any model: one of another guide may ask for kernels that the scene was not prepared for.
TEST(Guides, AModelOfAnotherGuideThanTheJobsIsRefused) {
    Scene scene = floor_from_above();
    scene.emitters.push_back({PointEmitter{{0.6f, 0.8f, 0.0f}, Rgb(3.0f)}, {}});
    for (const bool own : {false, true}) {
        const Resolved resolved = resolve(job_of("path"), scene);
        const RenderUnit render = make_renderer(scene, resolved);
        const auto kind =
            own ? guide_kind(resolved) : static_cast<GuideKind>(1 - static_cast<int>(guide_kind(resolved)));
        const AnyModel model = AnyModel::first(kind, scene.bounds(), {});
        PassPlan pass = plan_passes(resolved)[0];
        pass.kernel = kernel_of(resolved, pass, facts_of(model));
        const AnySampler guide(model);
        UnitOutput output;
        output.begin(guide);
        const WorkUnit unit{.pass = pass.index, .x1 = 1, .y1 = 1};
        if (own)
            EXPECT_NO_THROW(render(pass, guide, unit, output));
        else
            EXPECT_THROW(render(pass, guide, unit, output), RunError);
    }
}

/// E = I cos / d^2 on the floor, of which it reflects albedo / pi.
TEST(Direct, PointLightOverAPlane) {
    Scene scene = floor_from_above();
    scene.emitters.push_back({PointEmitter{{0.6f, 0.8f, 0.0f}, Rgb(3.0f)}, {}});
    for (const auto& [emitters, bsdfs] : {std::pair(1, 1), {4, 1}, {1, 3}, {2, 0}}) {
        Job job = job_of("direct");
        job.integrator.emitter_samples = emitters;
        job.integrator.bsdf_samples = bsdfs;
        expect_mean(scene, job, 0.5 / double(kPi) * 3.0 * 0.8, std::to_string(emitters));
    }
    Job job = job_of("direct");
    job.integrator.emitter_samples = 0;
    EXPECT_EQ(mean_of(test::render_locally(scene, job)).value, Rgb64(0.0)) << "no direction finds a point";
}

/// A ball of radius r and radiance L at distance d above the floor gives pi L (r / d)^2 (whole above its plane).
TEST(Direct, BallOverAPlane) {
    Scene scene = floor_from_above();
    test::add_shape(scene, Sphere{{0.0f, 2.0f, 0.0f}, 1.0f, false}, kNone, Rgb(2.0f));
    for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power, MisHeuristic::equal})
        for (const auto& [emitters, bsdfs] : {std::pair(1, 1), {4, 1}, {1, 4}, {0, 2}, {2, 0}}) {
            Job job = job_of("direct", 252);
            job.integrator.mis = mis;
            job.integrator.emitter_samples = emitters;
            job.integrator.bsdf_samples = bsdfs;
            expect_mean(scene, job, 0.5 * 2.0 * 0.25,
                        std::to_string(emitters) + " emitter and " + std::to_string(bsdfs) + " BSDF samples");
        }
}

/// One sample of each draws the numbers of a path of two edges.
TEST(Direct, IsTheReferenceOfTwoEdges) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 16, 16);
    for (const int depth : {1, 2}) {
        Job direct = job_of("direct", 12), reference = job_of("reference", 12);
        direct.integrator.max_depth = reference.integrator.max_depth = depth;
        expect_same_pixels(test::render_locally(scene, direct), test::render_locally(scene, reference));
    }
}

TEST(Direct, NeedsASampleOfSomeKind) {
    Job job = job_of("direct");
    job.integrator.emitter_samples = job.integrator.bsdf_samples = 0;
    EXPECT_THROW(check_job(job), InputError);
    job.integrator.type = "path";
    EXPECT_NO_THROW(check_job(job)) << "the numbers are another estimator's";
}

TEST(Normals, OfAPlaneABallAndNothing) {
    const auto colour = [](const Scene& scene) {
        return mean_of(test::render_locally(scene, job_of("normals", 4))).value;
    };
    Scene scene = floor_from_above();
    EXPECT_EQ(colour(scene), Rgb64(0.5, 1.0, 0.5));
    scene.camera = test::look_at({0.0f, -1.0f, 0.0f}, Vec3(0.0f), {0, 0, 1}, 1e-4f);
    EXPECT_EQ(colour(scene), Rgb64(0.5, 1.0, 0.5)) << "seen from behind it stays what it is";
    scene.camera = test::look_at({0.0f, 1.0f, 0.0f}, {0, 2, 0}, {0, 0, 1}, 1e-4f);
    EXPECT_EQ(colour(scene), Rgb64(0.0)) << "there is nothing above";
    test::add_shape(scene, Sphere{{0.0f, 3.0f, 0.0f}, 1.0f, false}, kNone);
    scene.camera = test::look_at({0.6f, 3.0f, -5.0f}, {0.6f, 3.0f, 0.0f}, {0, 1, 0}, 1e-6f);
    const Rgb64 ball = colour(scene);
    EXPECT_NEAR(ball.x, 0.5 + 0.5 * 0.6, 1e-4);
    EXPECT_NEAR(ball.y, 0.5, 1e-4);
    EXPECT_NEAR(ball.z, 0.5 - 0.5 * 0.8, 1e-4);
}

TEST(AmbientOcclusion, OfAnOpenPlaneAndTheSkyIsOne) {
    Scene scene = floor_from_above();
    EXPECT_EQ(mean_of(test::render_locally(scene, job_of("ao"))).value, Rgb64(1.0));
    scene.camera = test::look_at({0.0f, 1.0f, 0.0f}, {0, 2, 0}, {0, 0, 1}, 1e-4f);
    EXPECT_EQ(mean_of(test::render_locally(scene, job_of("ao"))).value, Rgb64(1.0));
}

/// Below a ceiling at height h a ray of length R stays free where cos < h / R: a share of (h / R)^2, by the cosine.
TEST(AmbientOcclusion, BelowACeiling) {
    Scene scene = floor_from_above();
    test::add_shape(scene, test::quad({-10, 1, -10}, {20, 0, 0}, {0, 0, 20}), kNone);
    for (const float length : {1.25f, 2.0f, 4.0f}) {
        Job job = job_of("ao", 252);
        job.integrator.ao_distance = length;
        expect_mean(scene, job, 1.0 / (length * length), std::to_string(length));
    }
    Job job = job_of("ao");
    job.integrator.ao_distance = 0.75f;
    EXPECT_EQ(mean_of(test::render_locally(scene, job)).value, Rgb64(1.0));
}

TEST(AmbientOcclusion, ReachesAQuarterOfTheScenesDiagonalUnlessTold) {
    Scene scene = floor_from_above();
    test::add_shape(scene, test::quad({-10, 1, -10}, {20, 0, 0}, {0, 0, 20}), kNone);
    Job told = job_of("ao");
    told.integrator.ao_distance = static_cast<float>(0.25 * std::sqrt(400.0 + 1.0 + 400.0));
    expect_same_pixels(test::render_locally(scene, job_of("ao")), test::render_locally(scene, told));
}

TEST(AmbientOcclusion, OfAClosedRoomIsDarkAtLast) {
    const Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    Job job = job_of("ao");
    job.integrator.ao_distance = 4.0f;
    EXPECT_EQ(mean_of(test::render_locally(scene, job)).value, Rgb64(0.0)) << "and emission does not count";
}

}  // namespace
}  // namespace treefarm
