// SPDX-License-Identifier: Apache-2.0
// Rays that leave emitters: their power, where they go and with what densities, against formulas and against next
// event.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "common/plan/resolve/resolve.h"
#include "tests/support/chi_square.h"
#include "tests/support/test_scenes.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {
namespace {

constexpr double kPiD = M_PI;

/// A kind of emitter, the scene that holds it alone, and watts that leave it (mean of the channels); 0: no formula.
struct EmissionCase {
    std::string name;
    Scene scene;
    double power = 0;
};

/// A square of side 2 on the plane z = 0 that faces up: what the light falls on.
constexpr int kCells = 4;
void add_receiver(Scene& scene) {
    test::add_shape(scene, test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), test::add_diffuse(scene, Rgb(0.5f)),
                    Rgb(0.0f), "receiver");
}

EmissionCase lamp(const std::string& name, decltype(Shape::geometry) geometry, double area) {
    EmissionCase made{name, {}, kPiD * area * 2.0};
    add_receiver(made.scene);
    test::add_shape(made.scene, std::move(geometry), kNone, Rgb(1.0f, 2.0f, 3.0f));
    return made;
}

template <class Kind>
EmissionCase without_shape(const std::string& name, const Kind& kind, double power) {
    EmissionCase made{name, {}, power};
    add_receiver(made.scene);
    made.scene.emitters.push_back({kind, {}});
    return made;
}

/// A texture of so many pixels with values from 0 to 1 that differ.
std::int32_t add_picture(Scene& scene, int width, int height) {
    TextureImage image;
    image.width = width;
    image.height = height;
    image.channels = 3;
    for (int i = 0; i < 3 * width * height; ++i)
        image.floats.push_back(static_cast<float>((7 * i + 3) % 11) / 11.0f);
    scene.images.push_back(std::move(image));
    return static_cast<std::int32_t>(scene.images.size()) - 1;
}

std::int32_t add_bitmap(Scene& scene) {
    BitmapTexture bitmap;
    bitmap.image = add_picture(scene, 4, 3);
    scene.textures.push_back({bitmap, {}, {}});
    return static_cast<std::int32_t>(scene.textures.size()) - 1;
}

/// 2 pi times the integral of sine and falloff.
double spot_power(double intensity, double cutoff, double beam) {
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double a = cutoff * (i + 0.5) / kSteps;
        sum += std::sin(a) * (a <= beam ? 1.0 : (cutoff - a) / (cutoff - beam)) * cutoff / kSteps;
    }
    return 2 * kPiD * intensity * sum;
}

double section(const Scene& scene) {
    const Box3 box = scene.bounds();
    const Vec3 d = box.max - box.min;
    return kPiD * 0.25 * double(dot(d, d));
}

/// Every kind of emitter.
std::vector<EmissionCase> emission_cases() {
    std::vector<EmissionCase> all;
    all.push_back(lamp("rectangle", test::quad({-0.5f, -0.7f, 1.5f}, {0, 1.4f, 0}, {1, 0, 0}), 1.4));
    all.push_back(lamp("box", test::box(Vec3(-0.4f, -0.3f, 0.8f), Vec3(0.4f, 0.5f, 1.2f), false),
                       2 * (0.8 * 0.8 + 0.8 * 0.4 + 0.8 * 0.4)));
    all.push_back(lamp("sphere", Sphere{Vec3(0.3f, 0.1f, 1.0f), 0.4f, false}, 4 * kPiD * 0.16));
    all.push_back(lamp("sphere around", Sphere{Vec3(0.1f, 0, 0.3f), 2.5f, true}, 4 * kPiD * 6.25));
    Disk disk;
    disk.center = Vec3(0.2f, -0.1f, 1.2f);
    disk.half_u = Vec3(0, 0.5f, 0);
    disk.half_v = Vec3(0.6f, 0, 0.1f);
    all.push_back(lamp("disk", disk, kPiD * 0.5 * std::sqrt(0.37)));
    Cylinder cylinder;
    cylinder.p0 = Vec3(-0.5f, 0.2f, 0.7f);
    cylinder.p1 = Vec3(0.5f, 0.2f, 0.9f);
    cylinder.radius = 0.2f;
    cylinder.meridian = Vec3(0, 1, 0);
    all.push_back(lamp("cylinder", cylinder, 2 * kPiD * 0.2 * std::sqrt(1.04)));

    EmissionCase textured = lamp("textured rectangle", test::quad({-0.5f, -0.7f, 1.5f}, {0, 1.4f, 0}, {1, 0, 0}), 0);
    std::get<Mesh>(textured.scene.shapes[1].geometry).uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    std::get<AreaEmitter>(textured.scene.emitters[0].kind).radiance.texture = add_bitmap(textured.scene);
    textured.power = 0;
    all.push_back(std::move(textured));

    all.push_back(without_shape("point", PointEmitter{{0.2f, 0.3f, 0.9f}, Rgb(1, 2, 3)}, 4 * kPiD * 2));
    SpotEmitter spot;
    spot.position = Vec3(0.1f, 0.2f, 2.0f);
    spot.axis = normalize(Vec3(0.1f, -0.1f, -1.0f));
    spot.intensity = Rgb(2.0f);
    spot.cutoff = 0.6f;
    spot.beam = 0.35f;
    all.push_back(without_shape("spot", spot, spot_power(2.0, 0.6, 0.35)));
    spot.cutoff = 2.5f;
    spot.beam = 2.5f;
    all.push_back(without_shape("wide spot", spot, spot_power(2.0, 2.5, 2.5)));
    spot.cutoff = 0.6f;
    spot.beam = 0.35f;
    EmissionCase slide = without_shape("spot with a slide", spot, 0);
    auto& with_slide = std::get<SpotEmitter>(slide.scene.emitters[0].kind);
    with_slide.y_axis = normalize(cross(spot.axis, Vec3(1, 0, 0)));
    with_slide.x_axis = cross(with_slide.y_axis, spot.axis);
    with_slide.texture = add_bitmap(slide.scene);
    all.push_back(std::move(slide));
    ProjectorEmitter projector;
    projector.position = Vec3(0.1f, 0, 1.5f);
    projector.axis = Vec3(0, 0, -1);
    projector.x_axis = Vec3(1, 0, 0);
    projector.y_axis = Vec3(0, -1, 0);
    projector.half_width = 0.7f;
    projector.half_height = 0.3f;
    projector.irradiance = ColorInput(Rgb(5.0f));
    all.push_back(without_shape("projector", projector, 5.0 * 4 * 0.7 * 0.3));
    EmissionCase picture = without_shape("projector with a picture", projector, 0);
    std::get<ProjectorEmitter>(picture.scene.emitters[0].kind).irradiance.texture = add_bitmap(picture.scene);
    all.push_back(std::move(picture));
    all.push_back(without_shape("parallel", DirectionalEmitter{normalize(Vec3(0.3f, 0.2f, -1)), Rgb(1, 2, 3)}, 0));
    all.back().power = section(all.back().scene) * 2;
    all.push_back(without_shape("constant", ConstantEmitter{Rgb(1, 2, 3)}, 0));
    all.back().power = section(all.back().scene) * 2 * kPiD * 4;
    EmissionCase sky{"image", {}, 0};
    add_receiver(sky.scene);
    EnvironmentEmitter image;
    image.image = add_picture(sky.scene, 16, 8);
    sky.scene.emitters.push_back({image, {}});
    sky.scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    all.push_back(std::move(sky));

    EmissionCase together = lamp("several", Sphere{Vec3(0.3f, 0.1f, 1.0f), 0.2f, false}, 4 * kPiD * 0.04);
    together.scene.emitters.push_back({PointEmitter{{-0.7f, 0.3f, 0.5f}, Rgb(0.5f)}, {}});
    together.power += 4 * kPiD * 0.5;
    all.push_back(std::move(together));
    return all;
}

EmissionSample emit(const TraceScene& scene, std::uint32_t i) {
    const PathKey key{17, i, 0};
    return scene.emitters().emit(draw(key, 0, Stream::light_start), draw(key, 0, Stream::light_scatter));
}

struct Sum {
    double sum = 0, squares = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
    }
    double mean(double n) const { return sum / n; }
    double variance_of_mean(double n) const { return std::max(0.0, squares / n - mean(n) * mean(n)) / n; }
};

double z_of(const Sum& a, const Sum& b, double n) {
    const double variance = a.variance_of_mean(n) + b.variance_of_mean(n);
    const double difference = a.mean(n) - b.mean(n);
    return std::abs(difference) <= 1e-9 * std::abs(b.mean(n)) ? 0.0 : difference / std::sqrt(variance);
}

int cell_of(const Vec3& p) {
    const auto along = [](float x) { return std::clamp(static_cast<int>((x + 1) * 0.5f * kCells), 0, kCells - 1); };
    return along(p.y) * kCells + along(p.x);
}

class EveryKind : public testing::TestWithParam<std::size_t> {};

/// Emitters whose power has a formula; what others bring to a surface is tested below.
TEST(EmissionPower, IsTheMeanWeight) {
    int compared = 0;
    for (const EmissionCase& given : emission_cases()) {
        if (given.power == 0) continue;
        const TraceScene scene(given.scene, resolve(Job(), given.scene));
        constexpr std::uint32_t kSamples = 100'000;
        Sum power;
        for (std::uint32_t i = 0; i < kSamples; ++i)
            power.add(double(average(emit(scene, i).weight)));
        EXPECT_NEAR(power.mean(kSamples), given.power,
                    4.5 * std::sqrt(power.variance_of_mean(kSamples)) + 1e-4 * given.power)
            << given.name;
        ++compared;
    }
    EXPECT_GE(compared, 12);
}

/// Watts on the parts of a square, by rays of the emitters and by sampling the emitters from there: where rays start
/// and where they go.
TEST_P(EveryKind, RaysBringWhatNextEventFinds) {
    const EmissionCase given = emission_cases()[GetParam()];
    const TraceScene scene(given.scene, resolve(Job(), given.scene));
    constexpr std::uint32_t kSamples = 200'000;
    std::array<Sum, kCells * kCells> by_rays, by_next_event;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const EmissionSample start = emit(scene, i);
        Hit hit;
        if (!is_black(start.weight) && scene.geometry().intersect(start.ray, hit) && hit.shape == 0 &&
            dot(hit.ng, start.ray.direction) < 0.0f)
            by_rays[static_cast<std::size_t>(cell_of(hit.p))].add(double(average(start.weight)));

        const Draw position = draw({18, i, 0}, 1, Stream::camera), light = draw({18, i, 0}, 1, Stream::light);
        Hit at;
        if (!scene.geometry().intersect(
                {{to_unit(position[0]) * 2 - 1, to_unit(position[1]) * 2 - 1, 1e-3f}, {0, 0, -1}}, at))
            continue;
        const DirectSample sample = scene.emitters().sample_direct(at.p, light);
        const float cosine = dot(at.ng, sample.wi);
        if (!(sample.pdf > 0.0f) || !(cosine > 0.0f) || scene.geometry().occluded(shadow_ray(at, sample))) continue;
        const Rgb radiance = sample.from_environment ? scene.emitters().environment(sample.wi) : sample.radiance;
        by_next_event[static_cast<std::size_t>(cell_of(at.p))].add(4.0 * double(average(radiance)) * double(cosine) /
                                                                   double(sample.pdf));
    }
    Sum all_rays, all_next_event;
    double worst = 0;
    for (std::size_t c = 0; c < by_rays.size(); ++c) {
        worst = std::max(worst, std::abs(z_of(by_rays[c], by_next_event[c], kSamples)));
        all_rays.sum += by_rays[c].sum;
        all_rays.squares += by_rays[c].squares;
        all_next_event.sum += by_next_event[c].sum;
        all_next_event.squares += by_next_event[c].squares;
    }
    EXPECT_LT(worst, 4.4) << given.name;
    EXPECT_LT(std::abs(z_of(all_rays, all_next_event, kSamples)), 4.0)
        << given.name << ": " << all_rays.mean(kSamples) << " and " << all_next_event.mean(kSamples);
    EXPECT_GT(all_rays.mean(kSamples), 0.0) << given.name << ": nothing was tested";
}

/// Densities that a sample says are those that are asked for, and next event's from where the ray arrives.
TEST_P(EveryKind, DensitiesAgree) {
    const EmissionCase given = emission_cases()[GetParam()];
    Job job;
    job.integrator.light_selection = LightSelection::power;  // as emission does
    const TraceScene scene(given.scene, resolve(job, given.scene));
    const Emitters& emitters = scene.emitters();
    int compared = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const EmissionSample start = emit(scene, i);
        const Vec3 away = start.ray.direction;
        Hit hit;
        if (is_black(start.weight) || !scene.geometry().intersect(start.ray, hit)) continue;
        const EmissionDensity density = start.from == EmissionFrom::surface
                                            ? emitters.emission_density(start.start, away)
                                            : emitters.emission_density(-away);
        if (start.is_delta()) {
            EXPECT_EQ(start.position_factor(hit.p), 0.0) << given.name;
            continue;
        }
        EXPECT_NEAR(density.position, start.position_pdf, 2e-3f * start.position_pdf) << given.name;
        EXPECT_NEAR(density.direction, start.direction_pdf, 1e-3f * start.direction_pdf + 1e-5f) << given.name;
        if (start.from == EmissionFrom::environment) {
            EXPECT_NEAR(start.next_pdf(hit.p, hit.ng), double(density.direction) * std::abs(double(dot(hit.ng, away))),
                        1e-5);
            ++compared;
            continue;
        }
        const bool by_cone = std::holds_alternative<Sphere>(given.scene.shapes[start.start.shape].geometry);
        if (by_cone || dot(start.start.ng, away) < 0.05f || std::abs(dot(hit.ng, away)) < 0.05f) continue;
        // Next event chooses points by area too, and says so per steradian.
        const double reverse = double(emitters.pdf_direct(hit.p, -away, start.start)) * start.position_factor(hit.p);
        EXPECT_NEAR(reverse, double(start.position_pdf), 1e-3 * double(start.position_pdf)) << given.name;
        const Vec3 d = hit.p - start.start.p;
        EXPECT_NEAR(start.next_pdf(hit.p, hit.ng),
                    double(start.direction_pdf) * std::abs(double(dot(hit.ng, away))) / double(dot(d, d)),
                    1e-4 * start.next_pdf(hit.p, hit.ng));
        ++compared;
    }
    const bool expects = emitters.shines_from_infinity() || given.name == "rectangle";
    if (expects) {
        EXPECT_GT(compared, 100) << given.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Emission, EveryKind, testing::Range<std::size_t>(0, emission_cases().size()),
                         [](const auto& info) {
                             std::string name = emission_cases()[info.param].name;
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

const EmissionCase& named(const std::string& name) {
    static const std::vector<EmissionCase> all = emission_cases();
    return *std::find_if(all.begin(), all.end(), [&](const EmissionCase& c) { return c.name == name; });
}

void expect_directions(const std::string& name, const std::function<double(const Vec3&)>& density) {
    const TraceScene scene(named(name).scene, {});
    const auto result = test::test_directions(
        [&](std::uint32_t i, Vec3& d) {
            const EmissionSample start = emit(scene, i);
            d = start.ray.direction;
            return start.from != EmissionFrom::nothing;
        },
        density, 200'000, 16, 48);
    EXPECT_GT(result.p_value, 1e-4) << name;
    EXPECT_NEAR(result.integral, 1.0, 5e-3) << name;
}

TEST(EmissionDirections, FollowTheirDensity) {
    expect_directions("rectangle", [](const Vec3& d) { return std::max(0.0, -double(d.z)) / kPiD; });
    expect_directions("sphere", [](const Vec3&) { return 0.25 / kPiD; });
    expect_directions("point", [](const Vec3&) { return 0.25 / kPiD; });
    const Vec3 axis = normalize(Vec3(0.1f, -0.1f, -1.0f));
    expect_directions("wide spot", [&](const Vec3& d) {
        return dot(d, axis) > std::cos(2.5f) ? 1.0 / (4 * kPiD * std::pow(std::sin(1.25), 2)) : 0.0;
    });
    const TraceScene sky(named("image").scene, {});
    expect_directions("image", [&](const Vec3& d) { return double(sky.emitters().emission_density(-d).position); });
}

TEST(EmissionDirections, OfAProjectorAreUniformOnItsPicture) {
    const TraceScene scene(named("projector").scene, {});
    constexpr std::uint32_t kSamples = 50'000;
    std::vector<double> counts(20), expected(20, kSamples / 20.0);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const EmissionSample start = emit(scene, i);
        const double cosine = -double(start.ray.direction.z), x = double(start.ray.direction.x) / cosine,
                     y = double(start.ray.direction.y) / cosine;
        EXPECT_NEAR(double(start.direction_pdf) * 0.84 * cosine * cosine * cosine, 1.0, 1e-4);
        const auto column = static_cast<std::size_t>(std::clamp((x + 0.7) / 1.4 * 5, 0.0, 4.99)),
                   row = static_cast<std::size_t>(std::clamp((y + 0.3) / 0.6 * 4, 0.0, 3.99));
        counts[row * 5 + column] += 1;
    }
    EXPECT_GT(test::chi_square_test(counts, expected), 1e-4);
}

TEST(Emission, WithoutSurfacesThereIsNone) {
    Scene scene;
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    EXPECT_EQ(emit(TraceScene(scene, {}), 0).from, EmissionFrom::nothing);
}

}  // namespace
}  // namespace treefarm
