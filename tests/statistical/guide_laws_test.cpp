// SPDX-License-Identifier: Apache-2.0
// Laws of all guides: the same tests over the closed set of common/guiding/guides.h and over guides beside others, on
// trained and on hostile models. Renders by guides are tested in guided_test, furnace_test and mpi/same_bits_test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cereal/types/array.hpp>
#include <cmath>
#include <random>
#include <string>
#include <thread>

#include "common/guiding/any_guide.h"
#include "common/math/frame.h"
#include "common/math/warp.h"
#include "common/protocol/archive.h"
#include "tests/support/chi_square.h"
#include "tests/support/lobe_guide.h"
#include "tests/support/random_tree.h"
#include "worker/guides/walks.h"
#include "worker/integrators/path/path_recorder.h"
#include "worker/shading/plain_diffuse.h"

namespace treefarm {
namespace {

constexpr double kGuideSignificance = 1e-4 / 8;  // models of one guide
constexpr std::uint32_t kGuideSamples = 1 << 19;

template <class List>
struct TypesOf;
template <class... G>
struct TypesOf<GuideList<G...>> {
    using type = ::testing::Types<G..., Beside<SdTreeGuide, GridGuide>, test::TreeBesideLobes,
                                  Beside<Beside<GridGuide, GridGuide>, test::LobeGuide>>;
    template <class Of>
    static constexpr bool kHas = (... || std::is_same_v<Of, G>);
};

/// Records at random places of a unit cube, or all alike.
using Records = std::vector<Record>;

template <class G>
class GuideLaws : public ::testing::Test {
  protected:
    using Model = typename G::Model;
    using Sampler = typename G::Sampler;

    /// Whether the program has the guide; if so, tests use it as the program does.
    static constexpr bool kListed = TypesOf<Guides>::template kHas<G>;
    using ModelOfAny = std::conditional_t<kListed, AnyModel, Model>;
    using LearnerOfAny = std::conditional_t<kListed, AnyLearner, typename G::Learner>;
    static ModelOfAny decoded(std::span<const std::uint8_t> bytes) {
        if constexpr (kListed)
            return AnyModel::decode(bytes);
        else
            return G::decode(bytes);
    }
    static const Model& model_of(const ModelOfAny& model) {
        if constexpr (kListed)
            return *model.template get_if<Model>();
        else
            return model;
    }
    static Sampler sampler_of(const ModelOfAny& model) {
        if constexpr (kListed)
            return AnySampler(model).template get<Sampler>();
        else
            return Sampler(model);
    }

    struct Named {
        std::string name;
        Model model;
        std::uint32_t region;  ///< to look at
        Vec3 position;         ///< in it
    };

    static Model first() {
        FirstModel settings;
        settings.with_lights = true;
        return G::first(Box3(Vec3(0.0f), Vec3(1.0f)), settings);
    }

    static CellSums sums_of(const Sampler& guide, std::uint32_t pass, const Records& records) {
        CellAccumulator<Sampler> accumulator(pass, guide, DirectionalFilter::box, true);
        accumulator.commit(records, counts_of(guide, records), {});
        return accumulator.take();
    }

    static std::vector<std::uint32_t> counts_of(const Sampler& guide, const Records& records) {
        std::vector<std::uint32_t> counts(guide.distribution_count());
        for (const Record& record : records)
            ++counts[record.distribution];
        return counts;
    }

    static Model learned(const Model& model, const Records& records) {
        typename G::Learner learner;
        RefineReport report;
        return learner.learn(model, sums_of(Sampler(model), model.pass, records),
                             {.spatial_threshold = 1000, .with_flux = true}, true, report);
    }

    /// Records in the middle of the cube, along one direction, of one value.
    static Records alike(const Sampler& guide, std::size_t count, float value, std::uint32_t code) {
        Records records(count, {guide.region(Vec3(0.5f)), code, 1u << 31, value, 0.0f, 0, true});
        for (Record& record : records)
            record.reflected = value;
        return records;
    }

    /// Models with a region that is worth a look, and what they are.
    static std::vector<Named> models() {
        std::vector<Named> all;
        const auto add = [&](const std::string& name, const Model& model, const Vec3& position) {
            all.push_back({name, model, Sampler(model).region(position), position});
        };
        const Sampler guide(first());
        const std::uint32_t code = direction_to_code(normalize(Vec3(0.3f, -0.5f, 0.7f)));
        const Vec3 middle(0.5f), corner(0.01f, 0.01f, 0.99f);
        add("before any pass", first(), middle);
        const Model trained = learned(first(), test::random_records(guide, 200'000, 1));
        add("trained", trained, middle);
        add("trained twice", learned(trained, test::random_records(Sampler(trained), 100'000, 2)), middle);
        add("one record", learned(first(), alike(guide, 1, 1.0f, code)), middle);
        add("all in one direction", learned(first(), alike(guide, 5000, 1.0f, code)), middle);
        add("nothing recorded there", learned(first(), alike(guide, 5000, 1.0f, code)), corner);
        add("tiny records", learned(first(), alike(guide, 100, 1e-30f, code)), middle);
        add("huge records", learned(first(), alike(guide, 100, 1e30f, code)), middle);
        return all;
    }
};
TYPED_TEST_SUITE(GuideLaws, TypesOf<Guides>::type);

/// Laws 1 and 2: what is drawn follows the density, which integrates to one.
TYPED_TEST(GuideLaws, DirectionsFollowTheirDensityWhichIntegratesToOne) {
    for (const auto& [name, model, region, position] : TestFixture::models()) {
        const typename TypeParam::Sampler guide(model);
        const auto drawn = [&, at = region](std::uint32_t i) {
            return guide.sample(at, draw({5, i, 0}, 0, Stream::scatter));
        };
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const auto s = drawn(i);
            d = s.direction;
            return s.pdf > 0.0f;
        };
        const auto density = [&, at = region](const Vec3& d) { return double(guide.pdf(at, direction_to_code(d))); };
        const auto result = test::test_directions(sample, density, kGuideSamples, 16, 64);
        EXPECT_NEAR(result.integral, result.success, 1e-3) << name;
        EXPECT_GT(result.p_value, kGuideSignificance) << name;
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const auto s = drawn(i);
            ASSERT_EQ(s.pdf, guide.pdf(region, s.code)) << name << ": drawn from another density than it is weighed by";
            ASSERT_NEAR(dot(s.direction, s.direction), 1.0f, 1e-5f) << name;
        }
    }
}

/// A diffuse surface that directions are drawn for.
class PlainSurface {
  public:
    static constexpr bool kGeneral = true;
    static bool smooth() { return true; }
    static bool view_dependent() { return false; }
    const PlainDiffuse& bsdf() const { return bsdf_; }
    const Frame& frame() const { return frame_; }
    const Vec3& wo() const { return wo_; }

  private:
    PlainDiffuse bsdf_{Rgb(0.8f), false};
    Frame frame_{normalize(Vec3(0.2f, 0.3f, 1.0f))};
    Vec3 wo_ = normalize(Vec3(0.5f, 0.1f, 0.8f));
};

struct GuideMoments {
    double sum = 0, squares = 0, count = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    double z(double exact) const {
        const double mean = sum / count;
        const double error = std::sqrt(std::max(squares / count - mean * mean, 1e-18) / count);
        return (mean - exact) / error;
    }
};

/// Law 3: the mixture of BSDF and guide estimates integrals of f cos g, as the walk draws and weighs it.
TYPED_TEST(GuideLaws, TheMixtureEstimatesIntegrals) {
    using Walk = WalkOf<typename TypeParam::Sampler>;
    const PlainSurface surface;
    const Vec3 side = normalize(cross(surface.frame().n, Vec3(1.0f, 0.0f, 0.0f)));
    for (const auto& [name, model, region, position] : TestFixture::models()) {
        const typename TypeParam::Sampler guide(model);
        typename Walk::Guidance guidance = Walk::unguided();
        guidance.region = region;
        guidance.bsdf_fraction = 0.3f;
        if constexpr (Walk::kLocal) {
            std::uint32_t outgoing = 0;
            Walk::template localise<true>(guide, surface, position, surface.frame().to_world(surface.wo()), outgoing,
                                          guidance);
        }
        auto scatter = std::make_unique<typename Walk::template ScatterBatch<true, true>>();
        GuideMoments all, tilted, half;
        for (std::uint32_t i = 0; i < kGuideSamples; ++i) {
            const Draw random = draw({6, i, 0}, 0, Stream::scatter);
            const Vec3 cosine = square_to_cosine_hemisphere({to_unit(random[2]), to_unit(random[3])});
            typename Walk::Scatter s;
            scatter->clear();
            double value = 0, along = 0;
            if (scatter->draw(surface, guide, guidance, to_unit(random[0]), random, cosine, s)) {
                scatter->convert(guide);
                scatter->complete(surface, guide, guidance, s);
                value = s.pdf > 0.0f ? double(s.f_cos.x / s.pdf) : 0.0;
                along = double(dot(s.world, side));
            }
            all.add(value);
            tilted.add(value * (1 + along));
            half.add(along > 0 ? value : 0.0);
        }
        EXPECT_LT(std::abs(all.z(0.8)), 4.5) << name;
        EXPECT_LT(std::abs(tilted.z(0.8)), 4.5) << name;
        EXPECT_LT(std::abs(half.z(0.4)), 4.5) << name;
    }
}

/// What a guide knows of the light is what it was taught.
TYPED_TEST(GuideLaws, TheRadianceItKnowsIsThatOfItsRecords) {
    using Sampler = typename TypeParam::Sampler;
    using Walk = WalkOf<Sampler>;
    const auto light = [](const Vec3& d) { return d.z > 0.0f ? 3.0f : 0.5f; };
    typename TypeParam::Model model = TestFixture::first();
    typename TypeParam::Learner learner;
    const Vec3 position(0.5f, 0.4f, 0.3f);
    EXPECT_LE(Sampler(model).radiance(Sampler(model).region(position), 0), 0.0f) << "nothing is known yet";
    for (std::uint32_t pass = 0; pass < 3; ++pass) {
        const Sampler guide(model);
        RecordLog log;
        log.begin(guide.distribution_count());
        log.drafts.resize(Walk::kRecordsPerVertex);
        typename Walk::Target target;
        target.region = guide.region(position);
        for (std::uint32_t i = 0; i < 100'000; ++i) {
            const Draw random = draw({8, i, pass}, 0, Stream::scatter);
            const Vec2 square(to_unit(random[0]), to_unit(random[1]));
            const TaughtDirection<Walk> taught{
                Walk::direction_at(square), kInvFourPi, light(square_to_direction(square)), 0.0f, {}};
            Record* const end = Walk::teach({}, random[2], target, taught, log, log.drafts.data());
            log.records.insert(log.records.end(), log.drafts.data(), end);
        }
        CellAccumulator<Sampler> accumulator(model.pass, guide);
        accumulator.commit(log.records, log.counts, {});
        RefineReport report;
        model = learner.learn(model, accumulator.take(), {.spatial_threshold = 1e9, .with_flux = true}, false, report);
    }
    const Sampler guide(model);
    for (const Vec3& d : {Vec3(0.1f, 0.2f, 1.0f), Vec3(-0.3f, 0.4f, 1.0f), Vec3(0.1f, -0.2f, -1.0f)})
        EXPECT_NEAR(guide.radiance(guide.region(position), direction_to_code(normalize(d))) / light(d), 1.0f, 0.1f);
}

/// Law 4: sums are the same bytes however their records are split, in whatever order and by how many threads.
TYPED_TEST(GuideLaws, SumsMergeToTheSameBytes) {
    using Sampler = typename TypeParam::Sampler;
    const typename TypeParam::Model model =
        TestFixture::learned(TestFixture::first(), test::random_records(Sampler(TestFixture::first()), 20'000, 3));
    const Sampler guide(model);
    Records records = test::random_records(guide, 20'000, 4);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].reflected = 0.5f * records[i].value;
        records[i].bin = static_cast<std::uint8_t>(i % kMixtureBins);
    }
    const CellSums whole = TestFixture::sums_of(guide, model.pass, records);
    const Bytes expected = whole.encode();
    std::mt19937 engine(9);
    for (const std::size_t parts : {1u, 2u, 3u, 7u, 17u}) {
        std::shuffle(records.begin(), records.end(), engine);
        CellSums merged(model.pass, whole.shape()), added(model.pass, whole.shape());
        CellAccumulator<Sampler> together(model.pass, guide, DirectionalFilter::box, true);
        std::vector<std::jthread> threads;
        for (std::size_t part = 0; part < parts; ++part) {
            const Records share(records.begin() + std::ptrdiff_t(records.size() * part / parts),
                                records.begin() + std::ptrdiff_t(records.size() * (part + 1) / parts));
            const CellSums sums = TestFixture::sums_of(guide, model.pass, share);
            added.add(sums);
            merged.merge_encoded(sums.encode());
            threads.emplace_back(
                [&together, &guide, share] { together.commit(share, TestFixture::counts_of(guide, share), {}); });
        }
        threads.clear();
        EXPECT_EQ(added.encode(), expected) << parts;
        EXPECT_EQ(merged.encode(), expected) << parts;
        EXPECT_EQ(together.take().encode(), expected) << parts << " threads";
    }
    CellSums untouched(model.pass, whole.shape());
    const Bytes nothing = untouched.encode();
    for (std::size_t cut = 1; cut < expected.size(); cut += expected.size() / 50 + 1) {
        EXPECT_THROW(untouched.merge_encoded({expected.data(), expected.size() - cut}), FormatError) << cut;
        EXPECT_EQ(untouched.encode(), nothing) << "a bad update changes nothing";
    }
}

/// Law 6: what is decoded is what was encoded, and so is what is sampled from it; nothing else is decoded.
TYPED_TEST(GuideLaws, WhatIsDecodedSamplesAlike) {
    for (const auto& [name, model, region, position] : TestFixture::models()) {
        const Bytes bytes = TypeParam::encode(model);
        const auto any = TestFixture::decoded(bytes);
        const typename TypeParam::Model& decoded = TestFixture::model_of(any);
        EXPECT_TRUE(decoded == model) << name;
        EXPECT_EQ(TypeParam::encode(decoded), bytes) << name;
        const typename TypeParam::Sampler before(model), after = TestFixture::sampler_of(any);
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const Draw random = draw({7, i, 0}, 0, Stream::scatter);
            const auto a = before.sample(region, random), b = after.sample(region, random);
            ASSERT_TRUE(a.direction == b.direction && a.code == b.code && a.pdf == b.pdf) << name;
            ASSERT_EQ(before.cell(region, a.code), after.cell(region, a.code)) << name;
        }
        for (std::size_t cut = 1; cut < bytes.size(); cut += bytes.size() / 50 + 1)
            EXPECT_THROW(TestFixture::decoded({bytes.data(), bytes.size() - cut}), FormatError) << name;
    }
}

/// What is kept of a learner in a checkpoint is all that it remembers.
TYPED_TEST(GuideLaws, WhoGoesOnFromACheckpointLearnsAlike) {
    using Sampler = typename TypeParam::Sampler;
    using Any = typename TestFixture::ModelOfAny;
    using Learner = typename TestFixture::LearnerOfAny;
    const Any first(TestFixture::first());
    const auto sums = [](const Any& model, unsigned seed) {
        const auto& of_guide = TestFixture::model_of(model);
        const Sampler guide(of_guide);
        Records records = test::random_records(guide, 20'000, seed);
        for (Record& record : records)
            record.reflected = 0.5f * record.value;
        for (std::uint32_t region = 0; region < guide.region_count(); ++region)
            records.push_back(light_record(region, guide.quantum_exponent(region), 3, 0.5f, 1.0f));
        return TestFixture::sums_of(guide, of_guide.pass, records);
    };
    const auto learn = [&](Learner& learner, const Any& model, unsigned seed) {
        RefineReport report;
        CellSums recorded = sums(model, seed);
        if constexpr (std::is_same_v<Learner, AnyLearner>)
            return learner.learn(model, recorded.take_blocks(), {.spatial_threshold = 1000}, true, report);
        else
            return learner.learn(model, recorded, {.spatial_threshold = 1000}, true, report);
    };
    Learner learner;
    const Any second = learn(learner, first, 1);
    ByteWriter writer;
    WriteArchive write(writer);
    write(learner);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    ReadArchive read(reader);
    Learner kept, forgetful;
    read(kept);
    reader.expect_end();
    const Any third = learn(learner, second, 2);
    EXPECT_TRUE(learn(kept, second, 2) == third);
    EXPECT_FALSE(learn(forgetful, second, 2) == third) << "it remembers nothing that matters";
}

/// What is told of a model in reports and plans is what it is.
TYPED_TEST(GuideLaws, FiguresAreTheModels) {
    for (const auto& [name, model, region, position] : TestFixture::models()) {
        const typename TypeParam::Sampler sampler(model);
        const ModelFigures figures = TypeParam::figures(model);
        EXPECT_EQ(figures.regions, sampler.region_count()) << name;
        EXPECT_EQ(figures.regions, model.leaf_count()) << name;
        EXPECT_EQ(figures.regions + figures.views, sampler.distribution_count()) << name;
        EXPECT_EQ(figures.cells, sampler.cell_count()) << name;
        if constexpr (TestFixture::kListed) {
            const AnyModel any(model);
            const auto counted = CellAccumulator<typename TypeParam::Sampler>(0, sampler).take();
            EXPECT_EQ(any.blocks(0, false).sums(0).shape(), counted.blocks().sums(0).shape()) << name;
            EXPECT_EQ(any.cells_by_region().size(), figures.regions) << name;
            const std::vector<float> map = any.density_map(region, 4);
            double sum = 0;
            for (const float density : map)
                sum += double(density) * 4 * 3.14159265358979 / double(map.size());
            EXPECT_NEAR(sum, 1.0, 1e-4) << name;
            // A table of the first halvings of space is there whatever the model.
            const SamplerCost cost = any.cost();
            const double table = 1 << 14;
            const double expected = double((cost.region + sizeof(LightProbabilities)) * figures.regions +
                                           cost.view * figures.views + cost.cell * figures.cells);
            EXPECT_NEAR((double(sampler.bytes()) - table) / expected, 1.0, 0.3) << name << ": plans forecast otherwise";
        }
    }
}

}  // namespace
}  // namespace treefarm
