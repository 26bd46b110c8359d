// SPDX-License-Identifier: Apache-2.0
// How far a render or a study is, and how long it still takes.
#include "coordinator/words/progress.h"

#include <gtest/gtest.h>

#include "coordinator/words/series_progress.h"

namespace treefarm {
namespace {

Job::Budget samples() {
    return {};
}

RenderProgress sixth_of_seven(double fraction, double run_seconds) {
    RenderProgress progress;
    progress.pass = 5;
    progress.pass_count = 7;
    progress.spp_total = 127;
    progress.fraction = fraction;
    progress.run_seconds = run_seconds;
    progress.error.known = true;
    progress.error.rmse = 0.428;
    progress.error.mean = 1;
    return progress;
}

Status status_of(const RenderProgress& progress, const Job::Budget& budget) {
    TimeLeftClock clock(budget);
    return render_status(render_words(progress, budget, clock.at(progress)));
}

TEST(TimeLeft, RunsDownWhileAUnitIsOut) {
    TimeLeftClock clock(samples());
    EXPECT_FALSE(clock.at(sixth_of_seven(0, 0.5)).known());
    double before = clock.at(sixth_of_seven(0.5, 10)).seconds;
    EXPECT_NEAR(before, 10, 1e-9);
    for (double now = 11; now < 20; ++now) {
        const double left = clock.at(sixth_of_seven(0.5, now)).seconds;
        EXPECT_LT(left, before);
        before = left;
    }
    EXPECT_FALSE(clock.at(sixth_of_seven(0.5, 21)).known()) << "it took longer: nobody knows";
    EXPECT_NEAR(clock.at(sixth_of_seven(0.75, 24)).seconds, 8, 1e-9);
}

TEST(TimeLeft, ToAnErrorIsAsItWasForecast) {
    Job::Budget budget;
    budget.error = 0.05;
    TimeLeftClock clock(budget);
    RenderProgress progress = sixth_of_seven(0.9, 30);
    EXPECT_FALSE(clock.at(progress).known());
    progress.target = {0.05, 400, 72, Trust::learning};
    progress.target_since = 28;
    double before = 72;
    for (const double now : {30.0, 40.0, 60.0}) {  // the fraction stands still
        progress.run_seconds = now;
        const TimeLeft left = clock.at(progress);
        EXPECT_NEAR(left.seconds, 72 - (now - 28), 1e-9);
        EXPECT_LT(left.seconds, before);
        EXPECT_STREQ(left.trust, "at most ");
        before = left.seconds;
    }
    budget.seconds = 65;  // comes before
    EXPECT_NEAR(TimeLeftClock(budget).at(progress).seconds, 5, 1e-9);
}

TEST(TimeLeft, BySecondsIsWhatIsLeftOfThem) {
    Job::Budget budget;
    budget.seconds = 60;
    const TimeLeft left = TimeLeftClock(budget).at(sixth_of_seven(0.1, 32));
    EXPECT_NEAR(left.seconds, 28, 1e-9);
    EXPECT_STREQ(left.trust, "");
}

TEST(Progress, OfSamples) {
    const Status status = status_of(sixth_of_seven(0.547, 7.07), samples());
    EXPECT_EQ(status.line, "pass 6/7   54 % of 127 spp   7.1 s   about 6 s left");
    EXPECT_EQ(status_text(status, 79),
              "[=========        ]  54 % of 127 spp   about 6 s left   pass 6/7   error 42.8 %");
}

TEST(Progress, OfSeconds) {
    Job::Budget budget;
    budget.seconds = 60;
    RenderProgress progress = sixth_of_seven(0.1, 32.4);
    progress.pass_count = 0;
    const Status status = status_of(progress, budget);
    EXPECT_EQ(status.line, "pass 6   54 % of 1:00   32.4 s   28 s left");
    EXPECT_NEAR(status.fraction, 0.54, 1e-9);
}

TEST(Progress, TowardsAnError) {
    Job::Budget budget;
    budget.error = 0.05;
    RenderProgress progress = sixth_of_seven(0.5, 30);
    progress.pass_count = 0;
    progress.target = {0.05, 400, 72, Trust::firm};
    progress.target_since = 28;
    const Status status = status_of(progress, budget);
    EXPECT_EQ(status.line, "pass 6   error 42.8 %, wanted 5 %   30.0 s   about 1:10 left");
    EXPECT_NEAR(status.fraction, 0.3, 1e-9);
}

TEST(Progress, BeforeTheFirstRay) {
    const Status status = render_status(preparing_words(3.1));
    EXPECT_EQ(status.line, "preparing the scene   3 s so far");
    EXPECT_EQ(status_text(status, 79), status.line);
}

TEST(SeriesProgress, CountsCellsAndTheirTime) {
    SeriesProgress study("cell", 4);
    study.begin("box.auto.1");
    RenderWords words;
    words.fraction = 0.5;
    words.how_far = "50 % of 2 s";
    words.pass = "pass 3";
    words.since_begin = "1.0 s";
    words.run_seconds = 1;
    EXPECT_EQ(study.status(words).line, "cell 1/4   box.auto.1   pass 3   50 % of 2 s   1.0 s");
    EXPECT_NEAR(study.status(words).fraction, 0.125, 1e-9);
    study.end(3);
    study.begin("box.none.1");
    EXPECT_EQ(study.status(words).line, "cell 2/4   box.none.1   pass 3   50 % of 2 s   1.0 s   about 8 s left");
    EXPECT_EQ(status_text(study.status(words), 40), "[====       ]  cell 2/4   about 8 s left");
}

}  // namespace
}  // namespace treefarm
