// SPDX-License-Identifier: Apache-2.0
#include "cli/plan_answer.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "common/base/text/duration_text.h"

namespace treefarm {

namespace {

std::string percent_text(double error) {
    return fmt::format("{:.3g}", 100 * error);
}

std::string spp_text(const Expected& spp) {
    if (spp.low == spp.high) return count_text(spp.value) + " spp";
    return fmt::format("about {} spp [{}, {}]", count_text(spp.value), count_text(spp.low), count_text(spp.high));
}

std::string error_text(const Expected& error) {
    if (error.low == error.high) return percent_text(error.value) + " %";
    return fmt::format("{} % [{}, {}]", percent_text(error.value), percent_text(error.low), percent_text(error.high));
}

const char* end_word(RenderEnd end) {
    return end == RenderEnd::error ? "error" : end == RenderEnd::seconds ? "seconds" : "spp";
}

/// Limit of a render's samples per pixel.
std::uint32_t most_spp(const Resolved& job) {
    return has_open_budget(job) ? job.budget.max_spp : job.budget.spp;
}

std::string question_text(const Resolved& job, RenderEnd end) {
    if (end == RenderEnd::error) return percent_text(job.budget.error) + " % error";
    return end == RenderEnd::seconds ? limit_text(job.budget.seconds) : count_text(most_spp(job)) + " spp";
}

/// Three significant digits of a count, so that a forecast does not look like a count.
double rounded(double count) {
    if (count < 1000) return std::round(count);
    const double unit = std::pow(10.0, std::floor(std::log10(count)) - 2);
    return std::round(count / unit) * unit;
}

Expectation expected_of(const Resolved& job, const RenderHistory& state, RenderEnd end) {
    if (end == RenderEnd::error) return expect_error(state, job, job.budget.error);
    if (end == RenderEnd::seconds) return expect_after_seconds(state, job, job.budget.seconds);
    return expect_after_spp(state, job, most_spp(job));
}

/// Sets the budget that ends the render, with its expected result.
void find_end(const Resolved& job, const RenderHistory& state, PlanAnswer& answer) {
    const bool by_error = job.budget.error > 0, by_seconds = job.budget.seconds > 0;
    answer.end = by_error ? RenderEnd::error : by_seconds ? RenderEnd::seconds : RenderEnd::spp;
    answer.expected = expected_of(job, state, answer.end);
    const auto ends_before = [&](RenderEnd other) {
        answer.end = other;
        answer.expected = expected_of(job, state, other);
    };
    if (by_error && by_seconds && answer.expected.known && answer.expected.seconds.value > job.budget.seconds)
        ends_before(RenderEnd::seconds);
    if (has_open_budget(job) && answer.expected.known && answer.expected.spp.value > job.budget.max_spp)
        ends_before(RenderEnd::spp);
}

}  // namespace

PlanAnswer answer_by_probe(const Resolved& job, Probe probe, double pixel_ratio) {
    PlanAnswer answer;
    for (PassFacts& pass : probe.state.passes) {
        pass.collect_seconds *= pixel_ratio;
        pass.overhead_seconds *= pixel_ratio;
        pass.trace_core_seconds *= pixel_ratio;
        pass.record_core_seconds *= pixel_ratio;
    }
    probe.state.seconds *= pixel_ratio;
    find_end(job, probe.state, answer);
    answer.probe = std::move(probe);
    answer.pixel_ratio = pixel_ratio;
    return answer;
}

std::string answer_words(const Resolved& job, const PlanAnswer& answer) {
    const Expectation& expected = answer.expected;
    const std::string text = question_text(job, answer.end) + ": ";
    if (!expected.known) return text + "not known: " + expected.unknown;
    if (answer.end == RenderEnd::error) return text + spp_text(expected.spp) + ", " + time_text(expected.seconds);
    if (answer.end == RenderEnd::seconds)
        return text + spp_text(expected.spp) + ", error " + error_text(expected.error);
    return text + "about " + time_text(expected.seconds) + ", error " + error_text(expected.error);
}

std::string answer_text(const Resolved& job, const PlanAnswer& answer) {
    const Probe& probe = answer.probe;
    const Expectation& expected = answer.expected;
    std::string text = answer_words(job, answer);
    if (expected.known) {
        text += " " + machine_text(probe);
        if (job.budget.error > 0 && answer.end == RenderEnd::seconds)
            text += fmt::format("\nthe {} % asked for would take longer", percent_text(job.budget.error));
        if (has_open_budget(job) && answer.end == RenderEnd::spp)
            text += fmt::format("\nbudget.max_spp = {} ends it there", job.budget.max_spp);
        if (expected.reached)
            text += probe.state.error.rmse > 0 ? "\nthe probe has come so far already" : "\nno noise was seen";
    }
    return text +
           fmt::format(
               "\nby a probe of {} spp in {} passes{}; the intervals are where most renders end up, and narrower after "
               "a longer one (--probe 30)\n\n",
               probe.state.spp(), probe.state.passes.size(), answer.pixel_ratio > 1 ? " on a smaller film" : "");
}

std::string time_text(const Expected& seconds) {
    if (seconds.low == seconds.high) return duration_text(seconds.value);
    return fmt::format("{} [{}, {}]", duration_text(seconds.value), duration_text(seconds.low),
                       duration_text(seconds.high));
}

std::string machine_text(const Probe& probe) {
    return fmt::format("on this machine ({} {})", probe.threads, probe.threads == 1 ? "thread" : "threads");
}

nlohmann::ordered_json figure_json(const Expected& figure) {
    return {{"value", figure.value}, {"low", figure.low}, {"high", figure.high}};
}

nlohmann::ordered_json answer_json(const PlanAnswer& answer) {
    const Expectation& expected = answer.expected;
    nlohmann::ordered_json json = {{"known", expected.known}};
    if (expected.known) {
        json["spp"] = figure_json(expected.spp);
        json["seconds"] = figure_json(expected.seconds);
        json["error"] = figure_json(expected.error);
        json["ends_by"] = end_word(answer.end);
    } else {
        json["why"] = expected.unknown;
    }
    json["threads"] = answer.probe.threads;
    json["probe"] = {{"spp", answer.probe.state.spp()},
                     {"passes", answer.probe.state.passes.size()},
                     {"pixel_ratio", answer.pixel_ratio},
                     {"whole_render", answer.probe.complete}};
    return json;
}

std::string count_text(double count) {
    if (!(count < 1e15)) return "very many";
    std::string digits = fmt::format("{:.0f}", rounded(count));
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, ",");
    }
    return digits;
}

}  // namespace treefarm
