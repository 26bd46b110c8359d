// SPDX-License-Identifier: Apache-2.0
// The smallest mutation of a path: its numbers are replayed, and one of them is moved. A Markov chain needs no more of
// the estimators (docs/design/transport.md, "Numbers of a path").
#include <gtest/gtest.h>

#include <cmath>

#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/test_scenes.h"
#include "worker/integrators/bidirectional/bidirectional_tracer.h"
#include "worker/integrators/light/light_tracer.h"
#include "worker/integrators/reference/path_tracer.h"

namespace treefarm {
namespace {

/// Numbers of a path, of which one is moved on the ring of 32-bit numbers.
struct OneMoved : PathKey {
    std::uint32_t vertex = 0;
    Stream stream{};
    std::size_t word = 0;
    std::uint32_t offset = 0;
};

Draw draw(const OneMoved& numbers, std::uint32_t vertex, Stream stream) {
    Draw random = draw(static_cast<const PathKey&>(numbers), vertex, stream);
    if (vertex == numbers.vertex && stream == numbers.stream) random[numbers.word] += numbers.offset;
    return random;
}

/// Light that a sample brings: to its own pixel, and to any pixel.
struct Brought {
    Rgb radiance{0.0f};
    std::vector<std::uint64_t> slots{};  ///< of the splats
    double splats = 0;                   ///< their sum over all channels

    bool operator==(const Brought&) const = default;
};

/// Tracer of one sample by any numbers.
class Numbered {
  public:
    Numbered(const std::string& type, int max_depth)
        : scene_(test::cornell_box(1.0f, Vec3(0.0f))), job_(resolve(job_of(type, max_depth), scene_)) {}

    Brought trace(const Numbers auto& numbers) {
        UnitOutput output;
        output.splats.begin(pass_.layers.splats);
        const EmissionChoice choice = traced_.emitters().emission_choice();
        EmissionRecord record(choice, false, pass_, output.stats.sums<EmissionSums>());
        Brought brought;
        const Ray ray = traced_.camera().generate(20, 40, numbers);
        if (job_.integrator.type == "reference") {
            PathTracer<DiffuseSurface> tracer(traced_, PathRules(traced_, job_.integrator, pass_), output.stats);
            brought.radiance = tracer.radiance(numbers, ray);
        } else if (job_.integrator.type == "light") {
            LightTracer<DiffuseSurface, std::remove_cvref_t<decltype(numbers)>> tracer(
                traced_, sensor_, LightPathRules(job_.integrator), choice, record, output);
            tracer.trace(numbers);
            tracer.finish();
        } else {
            BidirectionalTracer<DiffuseSurface> tracer(traced_, sensor_, BidirectionalRules(traced_, job_, pass_),
                                                       choice, record, pass_, output);
            brought.radiance = tracer.radiance(numbers, ray);
        }
        for (const SplatLog::Entry& entry : output.splats.summed()) {
            brought.slots.push_back(entry.slot);
            for (const std::uint64_t sum : entry.moments.sum)
                brought.splats += std::ldexp(double(sum), pass_.layers.splats.exponent);
        }
        return brought;
    }

  private:
    static Job job_of(const std::string& type, int max_depth) {
        Job job;
        job.integrator.type = type;
        job.integrator.max_depth = max_depth;
        return job;
    }

    Scene scene_;
    Resolved job_;
    PassPlan pass_ = plan_passes(job_)[0];
    TraceScene traced_{scene_, job_};
    Sensor sensor_{scene_.camera, scene_.film};
};

/// A direction at the second vertex: that of the camera's subpath, or of a path from the lamp.
OneMoved direction_moved(const std::string& type, std::uint32_t sample, std::uint32_t offset) {
    const Stream stream = type == "light" ? Stream::light_scatter : Stream::scatter;
    return {{7, 40 * 64 + 20, sample}, 2, stream, 2, offset};
}

class Mutation : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Numbers, Mutation, testing::Values("reference", "light", "bidirectional"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_P(Mutation, ReplaysAPathAndMovesWhatFollowsTheNumber) {
    Numbered before(GetParam(), GetParam() == std::string("light") ? 3 : 2), after(GetParam(), 6);
    int brought = 0, moved = 0;
    for (std::uint32_t sample = 0; sample < 300; ++sample) {
        const PathKey key = direction_moved(GetParam(), sample, 0);
        const OneMoved replayed = direction_moved(GetParam(), sample, 0);
        const OneMoved changed = direction_moved(GetParam(), sample, 0x40000000);
        const Brought whole = after.trace(key);
        brought += whole == Brought() ? 0 : 1;
        EXPECT_EQ(whole, after.trace(replayed)) << "a replay has the same bits";
        moved += whole == after.trace(changed) ? 0 : 1;
        EXPECT_EQ(before.trace(key), before.trace(changed)) << "the path ends before the number is used";
    }
    EXPECT_GT(brought, 50);
    EXPECT_GT(moved, 20);
}

/// A number moved by a constant is uniform as before.
TEST_P(Mutation, KeepsTheMean) {
    Numbered paths(GetParam(), 4);
    double sum = 0, squares = 0;
    constexpr std::uint32_t kSamples = 8000;
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
        const auto value = [&](std::uint32_t offset) {
            const Brought brought = paths.trace(direction_moved(GetParam(), sample, offset));
            return double(dot(brought.radiance, Rgb(1.0f))) + brought.splats;
        };
        const double difference = value(0x55555555) - value(0);
        sum += difference;
        squares += difference * difference;
    }
    EXPECT_GT(squares, 0.0) << "nothing was tested";
    EXPECT_LT(std::abs(sum), 4.5 * std::sqrt(squares));
}

TEST(MutationOfTheFirstNumbers, MovesACameraRay) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const CameraRays rays(scene.camera, scene.film);
    const PathKey key{7, 0, 3};
    const OneMoved moved{key, 0, Stream::camera, 1, 0x40000000};
    Draw random = draw(key, 0, Stream::camera);
    random[1] += 0x40000000;
    EXPECT_EQ(rays.generate(3, 5, moved).direction, rays.generate(3, 5, random).direction);
    EXPECT_NE(rays.generate(3, 5, moved).direction, rays.generate(3, 5, key).direction);
}

}  // namespace
}  // namespace treefarm
