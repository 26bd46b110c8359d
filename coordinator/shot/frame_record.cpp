// SPDX-License-Identifier: Apache-2.0
#include "coordinator/shot/frame_record.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "coordinator/shot/frames.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

const char* state_name(FrameState state) {
    switch (state) {
        case FrameState::waiting:
            return "not rendered";
        case FrameState::done:
            return "done";
        case FrameState::kept:
            return "kept";
        case FrameState::failed:
            return "failed";
        case FrameState::interrupted:
            return "interrupted";
    }
    return "";
}

std::string percent_text(const std::optional<double>& error) {
    return error ? fmt::format("{:.3g} %", 100 * *error) : "";
}

}  // namespace

std::string frame_folder(int frame) {
    return "frame." + frame_digits(frame);
}

std::string state_text(const FrameRecord& record) {
    std::string text = state_name(record.state);
    if (record.missed_target) text += ", error above the target";
    return record.message.empty() ? text : text + ": " + record.message;
}

std::vector<std::string> frame_table(std::span<const FrameRecord> records) {
    const auto line = [](const std::string& frame, const std::string& spp, const std::string& error,
                         const std::string& seconds, const std::string& state) {
        return fmt::format("{:>7}  {:>7}  {:>8}  {:>9}  {}", frame, spp, error, seconds, state);
    };
    std::vector<std::string> lines = {line("frame", "spp", "error", "seconds", "state")};
    for (const FrameRecord& record : records) {
        const bool rendered = record.spp > 0;
        lines.push_back(line(frame_digits(record.frame), rendered ? std::to_string(record.spp) : "",
                             percent_text(record.error), rendered ? fmt::format("{:.2f}", record.seconds) : "",
                             state_text(record)));
    }
    return lines;
}

Json shot_json(const std::string& command, std::span<const FrameRecord> records) {
    Json frames = Json::array();
    for (const FrameRecord& record : records) {
        Json frame = {{"frame", record.frame},
                      {"folder", frame_folder(record.frame)},
                      {"state", state_name(record.state)},
                      {"spp", record.spp},
                      {"seconds", record.seconds},
                      {"error", record.error ? Json(*record.error) : Json()},
                      {"image", record.image.string()}};
        if (record.missed_target) frame["missed_target"] = true;
        if (!record.message.empty()) frame["message"] = record.message;
        frames.push_back(std::move(frame));
    }
    return {{"command", command}, {"frames", frames}};
}

}  // namespace treefarm
