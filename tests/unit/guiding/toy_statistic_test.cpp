// SPDX-License-Identifier: Apache-2.0
// Statistics of other guides than those with cells, each a class that a guide names: CONTRIBUTING, "A statistic".
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <random>
#include <thread>

#include "common/evidence/evidence.h"
#include "common/guiding/guides.h"

namespace treefarm {
namespace {

/// Lobes on a circle, as a mixture of a frozen model: an example of what a worker samples from.
struct Lobes {
    static constexpr float kSharpness = 20.0f;
    std::vector<float> weight, angle;  ///< angles in turns

    float density(std::size_t lobe, float at) const {
        const float cosine = std::cos(2.0f * std::numbers::pi_v<float> * (at - angle[lobe]));
        return weight[lobe] * std::exp(kSharpness * (cosine - 1.0f));
    }
};

/// Angle of a record, by its code.
float angle_of(const Record& record) {
    return static_cast<float>(record.code) * 0x1p-32f;
}

/// Sums of a record's value by lobe, in proportion to the densities of a frozen model, with first moments: what
/// expectation maximisation needs (soft assignment).
class SoftStatistic {
  public:
    using Log = RecordLog;
    using Shape = std::size_t;  ///< number of lobes

    class Sums {
      public:
        Sums(std::uint32_t pass, Shape lobes) : Sums(pass, lobes, Blocks(shapes(lobes), pass)) {}
        Sums(std::uint32_t, Shape, Blocks blocks) : blocks_(std::move(blocks)) {}
        Blocks take_blocks() { return std::move(blocks_); }
        static UpdateCaps caps_of(const Blocks& blocks) { return {0, blocks.saturated(), 0}; }

        std::uint64_t weight(std::size_t lobe) const { return blocks_.sums(0).values()[lobe]; }
        double moment(std::size_t lobe, int axis) const {
            return blocks_.sums(1).signed_value(2 * lobe + static_cast<std::size_t>(axis));
        }
        void add(std::size_t lobe, std::uint64_t quanta, std::int64_t x, std::int64_t y) {
            blocks_.sums(0).add(lobe, quanta);
            blocks_.sums(1).add_signed(2 * lobe, x);
            blocks_.sums(1).add_signed(2 * lobe + 1, y);
        }

      private:
        static std::array<BlockShape, 2> shapes(Shape lobes) {
            return {
                {{"lobes", "quanta", BlockKind::sums, lobes}, {"moments", "quanta", BlockKind::signed_sums, lobes, 2}}};
        }

        Blocks blocks_;
    };

    SoftStatistic(std::uint32_t pass, const Lobes& lobes) : pass_(pass), lobes_(lobes), sums_(pass, size()) {}

    void commit(const Log& log) {
        const std::lock_guard lock(lock_);
        for (const Record& record : log.records) {
            const float at = angle_of(record);
            float all = 0;
            for (std::size_t lobe = 0; lobe < size(); ++lobe)
                all += lobes_.density(lobe, at);
            for (std::size_t lobe = 0; lobe < size(); ++lobe) {
                bool capped = false;
                const auto bits = scrambled(record.rounding, static_cast<std::uint32_t>(lobe));
                const auto quanta = quantise(record.value * lobes_.density(lobe, at) / all, -16, bits, capped);
                const double turn = 2.0 * std::numbers::pi * static_cast<double>(at);
                const auto part = [&](double factor) { return std::llround(static_cast<double>(quanta) * factor); };
                sums_.add(lobe, quanta, part(std::cos(turn)), part(std::sin(turn)));
            }
        }
    }
    Sums take() { return std::exchange(sums_, Sums(pass_, size())); }
    void give_back(Blocks) {}

  private:
    std::size_t size() const { return lobes_.weight.size(); }

    std::uint32_t pass_;
    Lobes lobes_;
    Sums sums_;
    std::mutex lock_;
};
static_assert(Statistic<SoftStatistic>);

/// Step of expectation maximisation.
Lobes learn(const SoftStatistic::Sums& sums, std::size_t lobes) {
    double all = 0;
    for (std::size_t lobe = 0; lobe < lobes; ++lobe)
        all += static_cast<double>(sums.weight(lobe));
    Lobes learned;
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
        learned.weight.push_back(static_cast<float>(static_cast<double>(sums.weight(lobe)) / all));
        learned.angle.push_back(
            static_cast<float>(std::atan2(sums.moment(lobe, 1), sums.moment(lobe, 0)) / (2.0 * std::numbers::pi)));
    }
    return learned;
}

/// Records of two lobes at 0.1 and 0.6 turns, of which the first has 30 % of the light, in logs of some work units.
template <class Log>
std::vector<Log> logs_of_two_lobes(std::uint32_t units) {
    std::vector<Log> logs(units);
    std::mt19937 random(7);
    std::normal_distribution<float> spread(0.0f,
                                           1.0f / (2.0f * std::numbers::pi_v<float> * std::sqrt(Lobes::kSharpness)));
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const float turns = (i % 10 < 3 ? 0.1f : 0.6f) + spread(random);
        typename Log::Record record{};
        record.code = static_cast<std::uint32_t>(static_cast<double>(turns - std::floor(turns)) * 0x1p32);
        record.rounding = static_cast<std::uint32_t>(random());
        record.value = 1.0f;
        if constexpr (requires { record.name; }) record.name = i;
        logs[i % units].records.push_back(record);
    }
    return logs;
}

TEST(SoftStatistic, TeachesAMixtureByExpectationMaximisation) {
    const auto logs = logs_of_two_lobes<RecordLog>(1);
    Lobes lobes{{0.5f, 0.5f}, {0.0f, 0.45f}};
    for (std::uint32_t pass = 0; pass < 15; ++pass) {
        SoftStatistic statistic(pass, lobes);
        statistic.commit(logs[0]);
        lobes = learn(statistic.take(), 2);
    }
    EXPECT_NEAR(lobes.weight[0], 0.3f, 0.01f);
    EXPECT_NEAR(lobes.angle[0], 0.1f, 0.002f);
    EXPECT_NEAR(lobes.angle[1] + 1.0f, 0.6f, 0.002f);
}

TEST(SoftStatistic, IsTheSameForAnyCutOfTheWork) {
    const Lobes lobes{{0.2f, 0.3f, 0.5f}, {0.0f, 0.3f, 0.7f}};
    const auto logs = logs_of_two_lobes<RecordLog>(24);
    Evidence expected(3, {SoftStatistic::Sums(3, 3).take_blocks()}), merged = expected;
    SoftStatistic all(3, lobes);
    for (const RecordLog& log : logs)
        all.commit(log);
    const auto send = [](SoftStatistic& statistic, Evidence& to) {
        const Blocks blocks = statistic.take().take_blocks();
        const Blocks* const owners[] = {&blocks};
        to.merge_encoded(encode_evidence(3, owners));
    };
    send(all, expected);
    for (std::size_t worker = 3; worker-- > 0;) {
        SoftStatistic own(3, lobes);
        std::vector<std::thread> threads;
        for (std::size_t thread = 0; thread < 2; ++thread)
            threads.emplace_back([&, thread] {
                for (std::size_t unit = 3 * thread + worker; unit < logs.size(); unit += 6)
                    own.commit(logs[unit]);
            });
        for (std::thread& thread : threads)
            thread.join();
        send(own, merged);
    }
    EXPECT_EQ(merged, expected);
}

/// A guide's own record, with the number that names it: of a path vertex, its pixel, sample and number.
struct NamedRecord : Record {
    std::uint64_t name;
};

/// Some of the pass's records, chosen by a keyed hash: what a map of photons consists of.
class ChosenStatistic {
  public:
    using Log = RecordLogOf<NamedRecord>;
    using Shape = std::size_t;  ///< number of records

    class Sums {
      public:
        Sums(std::uint32_t pass, Shape records) : Sums(pass, records, Blocks(shapes(records), pass)) {}
        Sums(std::uint32_t, Shape, Blocks blocks) : blocks_(std::move(blocks)) {}
        Blocks take_blocks() { return std::move(blocks_); }
        static UpdateCaps caps_of(const Blocks&) { return {}; }

        ChosenBlock& records() { return blocks_.chosen(0); }

      private:
        static std::array<BlockShape, 1> shapes(Shape records) {
            return {{{"photons", "code, value", BlockKind::chosen, records, 2}}};
        }

        Blocks blocks_;
    };

    ChosenStatistic(std::uint32_t pass, Shape records) : pass_(pass), shape_(records), sums_(pass, records) {}

    void commit(const Log& log) {
        const std::lock_guard lock(lock_);
        for (const NamedRecord& record : log.records) {
            const std::array<std::uint32_t, 2> words = {record.code, std::bit_cast<std::uint32_t>(record.value)};
            sums_.records().offer(record.name, words);
        }
    }
    Sums take() { return std::exchange(sums_, Sums(pass_, shape_)); }
    void give_back(Blocks) {}

  private:
    std::uint32_t pass_;
    Shape shape_;
    Sums sums_;
    std::mutex lock_;
};
static_assert(Statistic<ChosenStatistic>);

TEST(ChosenStatistic, IsTheSameForAnyCutOfTheWorkAndStandsForAllRecords) {
    constexpr std::size_t kKept = 2000;
    const auto logs = logs_of_two_lobes<ChosenStatistic::Log>(17);
    const auto by_workers = [&](std::size_t workers) {
        Evidence evidence(3, {ChosenStatistic::Sums(3, kKept).take_blocks()});
        for (std::size_t worker = workers; worker-- > 0;) {
            ChosenStatistic own(3, kKept);
            for (std::size_t unit = worker; unit < logs.size(); unit += workers)
                own.commit(logs[unit]);
            const Blocks blocks = own.take().take_blocks();
            const Blocks* const owners[] = {&blocks};
            evidence.merge_encoded(encode_evidence(3, owners));
        }
        return evidence;
    };
    Evidence evidence = by_workers(1);
    EXPECT_EQ(by_workers(3), evidence);
    EXPECT_EQ(by_workers(5), evidence);
    ChosenStatistic::Sums sums(3, kKept, evidence.take(0));
    ChosenBlock& kept = sums.records();
    ASSERT_EQ(kept.size(), kKept);
    double light = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (kept.words(i)[0] < 0x60000000u) light += 1.0 / kept.kept_share();  // of the lobe at 0.1 turns
    EXPECT_NEAR(light, 6000.0, 4 * std::sqrt(0.7 * 6000.0 / kept.kept_share()));
}

}  // namespace
}  // namespace treefarm
