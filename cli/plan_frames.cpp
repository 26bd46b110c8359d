// SPDX-License-Identifier: Apache-2.0
#include "cli/plan_frames.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <set>

namespace treefarm {

namespace {

const ProbedFrame* unknown_one(const std::vector<ProbedFrame>& probed) {
    const auto at = std::find_if(probed.begin(), probed.end(),
                                 [](const ProbedFrame& frame) { return !frame.answer.expected.known; });
    return at == probed.end() ? nullptr : &*at;
}

}  // namespace

std::vector<std::size_t> frames_to_probe(std::size_t count) {
    const std::set<std::size_t> indices = {0, (count - 1) / 2, count - 1};
    return {indices.begin(), indices.end()};
}

Expected seconds_of_frames(const std::vector<ProbedFrame>& probed, std::size_t count) {
    Expected total;
    for (std::size_t frame = 0, next = 0; frame < count; ++frame) {
        while (next + 1 < probed.size() && probed[next].index < frame)
            ++next;
        const ProbedFrame &b = probed[next], &a = next > 0 ? probed[next - 1] : b;
        const double length = static_cast<double>(b.index) - static_cast<double>(a.index);
        const double part = length > 0 ? (static_cast<double>(frame) - static_cast<double>(a.index)) / length : 1;
        const auto add = [&](double Expected::*figure) {
            total.*figure +=
                (1 - part) * (a.answer.expected.seconds.*figure) + part * (b.answer.expected.seconds.*figure);
        };
        add(&Expected::value);
        add(&Expected::low);
        add(&Expected::high);
    }
    return total;
}

std::string frames_text(const std::vector<ProbedFrame>& probed, std::size_t count) {
    const ProbedFrame& first = probed.front();
    std::string text = fmt::format("{} frames: ", count);
    if (const ProbedFrame* unknown = unknown_one(probed))
        text += fmt::format("not known: frame {}: {}\n", unknown->number, unknown->answer.expected.unknown);
    else
        text += fmt::format("{} in all {}\n", time_text(seconds_of_frames(probed, count)),
                            machine_text(first.answer.probe));
    for (const ProbedFrame& frame : probed)
        text += fmt::format("  frame {}: {}\n", frame.number, answer_words(frame.job, frame.answer));
    return text + fmt::format(
                      "by probes of {}; frames between them by interpolation; reading scenes and writing images "
                      "take longer\n\n",
                      probed.size() == 1 ? "the frame" : "the first, middle and last frame");
}

nlohmann::ordered_json frames_json(const std::vector<ProbedFrame>& probed, std::size_t count) {
    nlohmann::ordered_json json = {{"frames", count}, {"known", unknown_one(probed) == nullptr}};
    if (json["known"]) json["seconds"] = figure_json(seconds_of_frames(probed, count));
    json["probed"] = nlohmann::ordered_json::array();
    for (const ProbedFrame& frame : probed) {
        nlohmann::ordered_json one = answer_json(frame.answer);
        one["frame"] = frame.number;
        json["probed"].push_back(std::move(one));
    }
    return json;
}

}  // namespace treefarm
