// SPDX-License-Identifier: Apache-2.0
// The first sentence of a report on three and more methods: whom chance can have placed, who is surely slower, and
// whether the scenes agree.
#include <gtest/gtest.h>

#include <cmath>

#include "report/verdict.h"
#include "tests/support/made_study.h"

namespace treefarm {
namespace {

using namespace test;

/// A method's speed in a scene, relative to a method of speed 1, and the factor by which it scatters up and down.
struct Speed {
    std::string method;
    double speed, scatter = 1;
};

std::vector<CellResult> of_speeds(const std::string& scene, const std::vector<Speed>& speeds, std::size_t count = 6) {
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < count; ++k)
        for (const Speed& of : speeds) {
            const double speed = of.speed * (k % 2 == 0 ? of.scatter : 1 / of.scatter) * (1 + 0.001 * double(k % 3));
            cells.push_back(cell(scene, of.method, k, 0.05 / std::sqrt(speed)));
        }
    return cells;
}

StudyResults of_methods(std::vector<CellResult> cells, const std::vector<Speed>& speeds,
                        std::vector<SceneResult> scenes = {kRoom}) {
    StudyResults results = study(std::move(cells), std::move(scenes));
    results.methods.clear();
    for (const Speed& of : speeds)
        results.methods.push_back({of.method, {}});
    results.baseline = speeds.front().method;
    return results;
}

std::string first_line(const std::vector<Speed>& speeds) {
    return answers(of_methods(of_speeds("room", speeds), speeds), clocks()[0])[0];
}

TEST(Rivals, TheOneThatCannotBeToldIsNamedNotTheSecond) {
    const std::string text = first_line({{"unguided", 1}, {"auto", 1 / 1.17, 1.3}, {"ppg", 1 / 1.08}});
    expect_part(text, "Cannot tell who won: unguided came out first, 1.17 [");
    expect_part(text, "times as fast as auto, which may be chance; ppg is surely slower (to equal");
    expect_no_part(text, "as fast as ppg, which may be chance");
    expect_part(text, "Picked as the best of 3 methods; the intervals are not corrected for that.");
}

TEST(Rivals, OfFiveThoseWhoMayHaveWonAreNamed) {
    const std::string text = first_line({{"plain", 1}, {"a", 4}, {"b", 3.9}, {"c", 3.5, 1.5}, {"d", 3, 1.7}});
    expect_part(text,
                "a, c or d won, which of them cannot be told: a is 4 [4, 4] times as fast as plain, but its "
                "leads over c (1.14 [");
    expect_part(text, ") and d (1.33 [");
    expect_part(text, ") may be chance");
    expect_no_part(text, "over b (");
    expect_part(text, "best of 5 methods");
}

TEST(Rivals, ACertainWinnerIsComparedWithBaselineAndNextBest) {
    const std::string text = first_line({{"plain", 1}, {"a", 4}, {"b", 2}});
    expect_part(text, "a won: 4 [4, 4] times as fast as plain, 2 [2, 2] times as fast as b, the next best (to");
    expect_no_part(first_line({{"plain", 1}, {"a", 4}}), "Picked as the best of");
}

TEST(Rivals, AreComparedBySeedsThatAllHave) {
    // Without the two hardest seeds "late" would come out first, though it lost on all others.
    std::vector<CellResult> cells;
    for (std::size_t k = 0; k < 5; ++k) {
        const double hard = (k < 2 ? 2 : 1) * (1 + 0.001 * double(k));
        cells.push_back(cell("room", "plain", k, 0.05));
        cells.push_back(cell("room", "steady", k, 0.04 * hard));
        if (k >= 2) cells.push_back(cell("room", "late", k, 0.041 * hard));
    }
    const std::string text =
        answers(of_methods(std::move(cells), {{"plain", 1}, {"steady", 1}, {"late", 1}}), clocks()[0])[0];
    expect_part(text, "steady won: ");
}

TEST(Rivals, ScenesThatDisagreeAreNamed) {
    const std::vector<Speed> room = {{"plain", 1}, {"guided", 8}}, hall = {{"plain", 1}, {"guided", 0.5}};
    std::vector<CellResult> cells = of_speeds("room", room), more = of_speeds("hall", hall);
    cells.insert(cells.end(), more.begin(), more.end());
    const std::string text = answers(of_methods(std::move(cells), room, {kRoom, kHall}), clocks()[0])[0];
    expect_part(text, "All scenes: guided won: 2 [2, 2] times as fast as plain");
    expect_part(text, "Scenes disagree: in hall plain was 2 [2, 2] times as fast as guided.");
}

TEST(Rivals, ScenesThatMayDisagreeAreNamedAsSuch) {
    const std::vector<Speed> room = {{"plain", 1}, {"guided", 8}}, hall = {{"plain", 1}, {"guided", 0.9, 1.5}};
    std::vector<CellResult> cells = of_speeds("room", room), more = of_speeds("hall", hall);
    cells.insert(cells.end(), more.begin(), more.end());
    const std::string text = answers(of_methods(cells, room, {kRoom, kHall}), clocks()[0])[0];
    expect_part(text, "Scenes may disagree: in hall plain was 1.11 [");
    std::vector<CellResult> agreeing = of_speeds("room", room), same = of_speeds("hall", room);
    agreeing.insert(agreeing.end(), same.begin(), same.end());
    expect_no_part(answers(of_methods(agreeing, room, {kRoom, kHall}), clocks()[0])[0], "disagree");
}

}  // namespace
}  // namespace treefarm
