// SPDX-License-Identifier: Apache-2.0
// Q-learning by the table of radiances: what a visit teaches, and where that leads.
#include "common/guiding/qtable/qtable.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/guiding/statistics/cell_accumulator.h"
#include "common/math/direction_map.h"
#include "worker/guides/qtable_walk.h"
#include "worker/integrators/path/path_recorder.h"

namespace treefarm {
namespace {

/// A table of two regions, below and above x = 0.5.
QTableModel two_regions() {
    FirstModel settings;
    settings.grid_halvings = 1;
    return QTableGuide::first(Box3(Vec3(0.0f), Vec3(1.0f)), settings);
}

QTableModel learned(QTableGuide::Learner& learner, const QTableModel& model, const RecordLog& log) {
    const QTableSampler guide(model);
    CellAccumulator<QTableSampler> accumulator(model.pass, guide);
    accumulator.commit(log.records, log.counts, {});
    RefineReport report;
    return learner.learn(model, accumulator.take(), {}, false, report);
}

Record visit(std::uint32_t region, std::uint32_t code, float value) {
    return {region, code, 1u << 31, value, 0.0f, 0, true};
}

TEST(QTable, IsTheMeanOfVisitsThoseOfEarlierPassesAtHalfTheirWeight) {
    const std::uint32_t code = direction_to_code(normalize(Vec3(0.2f, 0.1f, 1.0f)));
    QTableGuide::Learner learner;
    QTableModel model = two_regions();
    RecordLog log;
    log.begin(2);
    log.records = {visit(0, code, 1.0f), visit(0, code, 2.0f), visit(0, code, 0.0f), visit(0, code, 5.0f)};
    log.counts = {4, 0};
    model = learned(learner, model, log);
    EXPECT_NEAR(QTableSampler(model).radiance(0, code), 2.0f, 1e-3f) << "a visit that found nothing is one, too";
    EXPECT_EQ(QTableSampler(model).radiance(1, code), 0.0f);
    log.records = {visit(0, code, 8.0f), visit(0, code, 8.0f)};
    log.counts = {2, 0};
    model = learned(learner, model, log);
    EXPECT_NEAR(QTableSampler(model).radiance(0, code), (2.0f * 2 + 8.0f * 2) / 4, 1e-3f);
    log.begin(2);
    model = learned(learner, model, log);
    EXPECT_NEAR(QTableSampler(model).radiance(0, code), 5.0f, 1e-3f) << "nothing new leaves it";
}

TEST(QTable, RecordsOfTheMixtureAloneAreNoVisits) {
    RecordLog log;
    log.begin(2);
    log.drafts.resize(8);
    const QTableWalk::Target target{1};
    const TaughtDirection<QTableWalk> smooth{77u, 0.5f, 3.0f, 0.7f, 2}, delta{0u, 0.0f, 3.0f, 0.7f, 15},
        of_next_event{78u, 0.5f, 3.0f, 0.7f, {}, false};
    Record* end = log.drafts.data();
    end = QTableWalk::teach({}, 1, target, smooth, log, end);
    end = QTableWalk::teach({}, 1, target, delta, log, end);
    end = QTableWalk::teach({}, 1, target, of_next_event, log, end);
    ASSERT_EQ(end - log.drafts.data(), 2);
    EXPECT_TRUE(log.drafts[0].visit);
    EXPECT_EQ(log.drafts[0].value, 3.0f) << "radiance, not over the density";
    EXPECT_FALSE(log.drafts[1].visit);
    EXPECT_EQ(log.drafts[1].value, 0.0f);
    EXPECT_EQ(log.drafts[1].reflected, 0.7f);
    EXPECT_EQ(log.counts, (std::vector<std::uint32_t>{0, 1}));
}

/// What is never visited keeps a part of the probability, and radiance() knows nothing of that part.
TEST(QTable, SamplesInProportionToQButForAFloor) {
    QTableModel model = two_regions();
    const std::uint32_t bright = direction_to_code(normalize(Vec3(0.2f, 0.1f, 1.0f))),
                        dark = direction_to_code(normalize(Vec3(0.2f, 0.1f, -1.0f)));
    model.q[QTableSampler::cell(0, bright)] = 64.0f;
    const QTableSampler guide(model);
    const double floor = kTableFloor, total = 64 + 63 * floor;
    EXPECT_NEAR(double(guide.pdf(0, bright) / guide.pdf(0, dark)), 64 / floor, 1.0);
    EXPECT_NEAR(double(guide.pdf(0, bright)), 64 / total * kStrata / (4 * 3.14159265), 1e-4);
    EXPECT_EQ(guide.radiance(0, dark), 0.0f);
    EXPECT_NEAR(double(guide.pdf(1, dark)), 1 / (4 * 3.14159265), 1e-6) << "nothing known: all alike";
}

TEST(QTable, HostileBytesAreRefused) {
    const auto refused = [](const QTableModel& model) {
        EXPECT_THROW(QTableGuide::decode(QTableGuide::encode(model)), FormatError);
    };
    QTableModel model = two_regions();
    EXPECT_EQ(QTableGuide::decode(QTableGuide::encode(model)), model);
    model.q[3] = -1.0f;
    refused(model);
    model.q[3] = std::numeric_limits<float>::infinity();
    refused(model);
    model.q[3] = std::nanf("");
    refused(model);
    model = two_regions();
    model.q.pop_back();
    refused(model);
    model = two_regions();
    model.flux = {1.0f, -1.0f};
    refused(model);
}

/// Two parallel infinite planes of albedos r1 and r2, of which the second emits L: what arrives at the first is
/// L / (1 - r1 r2), at the second r1 L / (1 - r1 r2). One bounce a pass is learned, from nothing: without a memory the
/// error would be (r1 r2)^ceil(k / 2) of that after k passes.
TEST(QTable, TwoPlanesHaveTheirFixedPoint) {
    const double albedo[] = {0.8, 0.5}, emitted = 1.0, first = emitted / (1 - albedo[0] * albedo[1]);
    const std::uint32_t code[] = {direction_to_code(normalize(Vec3(1.0f, 0.3f, 0.2f))),
                                  direction_to_code(normalize(Vec3(-1.0f, 0.3f, 0.2f)))};
    QTableGuide::Learner learner;
    QTableModel model = two_regions();
    double expected[] = {0, 0}, visits = 0;
    for (int pass = 1; pass <= 60; ++pass) {
        const QTableSampler guide(model);
        PathRecorder<QTableWalk> recorder({.bootstrap = 1.0f});
        RecordLog log;
        log.begin(2);
        const int paths = 1 << std::min(pass, 10);
        for (int path = 0; path < 2 * paths; ++path) {
            // From one plane to the other, and on from there, which is what the first vertex learns from.
            recorder.begin_path();
            for (const auto plane : {static_cast<std::uint32_t>(path % 2), static_cast<std::uint32_t>(1 - path % 2)}) {
                const QTableWalk::Target target =
                    recorder.vertex_count() == 0 ? QTableWalk::Target{plane} : QTableWalk::Target{};
                recorder.add_vertex(target, code[plane], 0.3f, Rgb(static_cast<float>(albedo[plane])), {3}, 1u << 31,
                                    guide.radiance(plane, code[plane]));
                if (plane == 0) recorder.add_emission(Rgb(static_cast<float>(emitted)));
            }
            recorder.commit(log);
        }
        const double fresh[] = {emitted + albedo[1] * expected[1], albedo[0] * expected[0]};
        for (int plane = 0; plane < 2; ++plane)
            expected[plane] = (expected[plane] * visits / 2 + fresh[plane] * paths) / (visits / 2 + paths);
        visits = visits / 2 + paths;
        model = learned(learner, model, log);
        for (std::uint32_t plane = 0; plane < 2; ++plane)
            EXPECT_NEAR(double(QTableSampler(model).radiance(plane, code[plane])), expected[plane], 1e-4) << pass;
        if (pass > 1) continue;
        EXPECT_NEAR(double(QTableSampler(model).radiance(0, code[0])), 1.0, 1e-4) << "what it met at once";
    }
    EXPECT_NEAR(double(QTableSampler(model).radiance(0, code[0])), first, 1e-4);
    EXPECT_NEAR(double(QTableSampler(model).radiance(1, code[1])), albedo[0] * first, 1e-4);
}

}  // namespace
}  // namespace treefarm
