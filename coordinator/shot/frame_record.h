// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "coordinator/render/finished_render.h"

namespace treefarm {

/// How a frame stands.
enum class FrameState : std::uint8_t {
    waiting,
    done,
    kept,         ///< done before, by the same request
    failed,       ///< its message says why
    interrupted,  ///< what its finished passes gave is there
};

/// A frame of a shot, and what is told of it.
struct FrameRecord : RenderFigures {
    int frame = 0;
    FrameState state = FrameState::waiting;
    std::string message;  ///< what went wrong
};

/// Name of a frame's run directory in that of the shot: "frame.0007".
std::string frame_folder(int frame);

/// "done", "kept", "failed: scene.xml:3:7: ...": the state in words, and what went wrong.
std::string state_text(const FrameRecord& record);

/// A table of all frames, a line each below its header.
std::vector<std::string> frame_table(std::span<const FrameRecord> records);

/// The file shot.json.
nlohmann::ordered_json shot_json(const std::string& command, std::span<const FrameRecord> records);

}  // namespace treefarm
