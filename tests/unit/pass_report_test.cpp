// What is said of a pass to a person.
#include "coordinator/pass_report.h"

#include <gtest/gtest.h>

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

TEST(PassReport, ErrorsAreSaidAsTheyAre) {
    EXPECT_EQ(error_text({}), "error not known yet");
    EXPECT_EQ(error_text(known(0.1, 2)), "error 5 % [4.5, 6]");
    EXPECT_EQ(error_text(known(0, 2)), "no noise seen");
    EXPECT_EQ(error_text(known(0, 0)), "no light found yet");
}

TEST(PassReport, ForecastsSayHowFarTheyGo) {
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::firm}), "about 12 s");
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::learning}), "at most 12 s (still learning)");
    EXPECT_EQ(forecast_text({0.05, 10, 12, Trust::noisy}), "roughly 12 s (the error itself is not known well)");
}

TEST(PassReport, ALineEndsInWhatIsLeftToDo) {
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
