// SPDX-License-Identifier: Apache-2.0
// What is said of a pass to a person.
#include "coordinator/words/pass_text.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/base/text/duration_text.h"

namespace treefarm {
namespace {

ErrorEstimate known(double rmse, double mean) {
    ErrorEstimate error;
    error.known = error.has_interval = true;
    error.rmse = rmse;
    error.low = 0.9 * rmse;
    error.high = 1.2 * rmse;
    error.mean = mean;
    return error;
}

PassReport sixth_pass() {
    PassReport report;
    report.plan.index = 5;
    report.plan.spp = 32;
    report.spp_done = 63;
    report.run_seconds = 7.07;
    report.error = known(0.428, 1);
    report.halving = {0.214, 180, 70, Trust::firm};
    return report;
}

TEST(PassText, ErrorsAreSaidAsTheyAre) {
    EXPECT_EQ(error_text({}), "error not known yet");
    EXPECT_EQ(error_text(known(0.1, 2)), "error 5 % [4.5, 6]");
    EXPECT_EQ(error_text(known(0, 2)), "no noise seen");
    EXPECT_EQ(error_text(known(0, 0)), "no light found yet");
    EXPECT_EQ(brief_error_text(known(0.1, 2)), "error 5 %");
}

TEST(PassText, ForecastsSayHowFarTheyGo) {
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::firm}), "about 12 s");
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::learning}), "at most 12 s (still learning)");
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::noisy}), "roughly 12 s (the error itself is not known well)");
}

TEST(PassText, DurationsReadAsOnAClock) {
    EXPECT_EQ(duration_text(0.034), "0.034 s");
    EXPECT_EQ(duration_text(7.07), "7.1 s");
    EXPECT_EQ(duration_text(59.96), "1:00");
    EXPECT_EQ(duration_text(70), "1:10");
    EXPECT_EQ(duration_text(3600 + 62), "1:01:02");
    EXPECT_EQ(duration_text(11.5 * 3600), "11:30:00");
    EXPECT_EQ(duration_text(10 * 86400.0), "10 days");
    EXPECT_EQ(limit_text(10), "10 s");
    EXPECT_EQ(limit_text(0.25), "0.25 s");
    EXPECT_EQ(limit_text(90), "1:30");
    EXPECT_EQ(rough_duration_text(0.2), "1 s");
    EXPECT_EQ(rough_duration_text(5.6), "6 s");
    EXPECT_EQ(rough_duration_text(6 * 3600 + 58 * 60 + 4), "6:58:00") << "no forecast is right to the second";
    EXPECT_EQ(rough_duration_text(14 * 3600 + 3 * 60 + 40), "14:04:00");
    EXPECT_EQ(rough_duration_text(std::numeric_limits<double>::infinity()), "a very long time");
}

TEST(PassText, APassIsOneShortLine) {
    EXPECT_EQ(pass_line(sixth_pass(), 7), "pass 6/7   63 spp   7.1 s   error 42.8 %   half in about 1:10");
    EXPECT_EQ(pass_line(sixth_pass(), 0), "pass 6   63 spp   7.1 s   error 42.8 %   half in about 1:10");
}

TEST(PassText, WhereAnErrorWasAskedForTheLineIsAboutThat) {
    PassReport report = sixth_pass();
    report.target = {0.05, 1e5, 725, Trust::learning};
    EXPECT_EQ(pass_line(report, 0), "pass 6   63 spp   7.1 s   error 42.8 %   5 % in at most 12:05");
    report.target.seconds = 0;  // it is there
    EXPECT_EQ(pass_line(report, 0), "pass 6   63 spp   7.1 s   error 42.8 %");
}

TEST(PassText, TheLongestLineFits80Columns) {
    PassReport report = sixth_pass();
    report.plan.index = 19;
    report.spp_done = 1048575;
    report.run_seconds = 47 * 3600.0 + 59;
    report.error = known(0.00034567, 1);
    report.halving = {0.0001, 1e7, 46 * 3600.0, Trust::learning};
    const std::string line = pass_line(report, 20);
    EXPECT_LE(line.size(), 80u) << line;
}

TEST(PassText, WhatIsNotKnownIsNotSaid) {
    PassReport first;
    first.plan.spp = first.spp_done = 1;
    first.halving.seconds = std::numeric_limits<double>::infinity();
    EXPECT_EQ(pass_line(first, 7), "pass 1/7   1 spp   0 s   error not known yet");
    const std::string summary = pass_summary(first, 7);
    for (const char* word : {"stuv", "ttuv", "efficiency", " % in "})
        EXPECT_EQ(summary.find(word), std::string::npos) << summary;
    first.variance.stuv = 2;
    EXPECT_NE(pass_summary(first, 7).find("stuv 2, ttuv"), std::string::npos);
}

TEST(PassText, TheSummaryEndsInWhatIsLeftToDo) {
    PassReport report;
    report.error = known(0.1, 2);
    report.run_seconds = 1;
    report.halving = {0.025, 100, 9, Trust::firm};
    const std::string line = pass_summary(report, 3);
    EXPECT_NE(line.find("; 2.5 % in about 9 s"), std::string::npos) << line;
    report.error = known(0, 2);
    report.halving = {0, 0, 0, Trust::firm};
    const std::string quiet = pass_summary(report, 3);
    EXPECT_EQ(quiet.find(" % in "), std::string::npos) << quiet;
    EXPECT_EQ(quiet.find("efficiency"), std::string::npos) << quiet;
}

}  // namespace
}  // namespace treefarm
