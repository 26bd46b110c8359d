// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "coordinator/render/finished_render.h"

namespace treefarm {

/// State of a frame.
enum class FrameState : std::uint8_t {
    waiting,
    done,
    kept,         ///< finished before, by an equal request
    failed,       ///< the message has the reason
    interrupted,  ///< the image of its finished passes exists
};

/// A frame of a shot, with its reported figures.
struct FrameRecord : RenderFigures {
    int frame = 0;
    FrameState state = FrameState::waiting;
    std::string message;  ///< reason of the failure
};

/// Name of a frame's run directory within that of the shot: "frame.0007".
std::string frame_folder(int frame);

/// State in words, with the reason of a failure: "done", "kept", "failed: scene.xml:3:7: ...".
std::string state_text(const FrameRecord& record);

/// Table of all frames: a header, then a line for each.
std::vector<std::string> frame_table(std::span<const FrameRecord> records);

/// Content of the file shot.json.
nlohmann::ordered_json shot_json(const std::string& command, std::span<const FrameRecord> records);

}  // namespace treefarm
