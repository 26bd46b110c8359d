// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coordinator/checkpoint/section_file.h"
#include "coordinator/passes/render_state.h"

namespace treefarm {

/// Origin of a checkpoint: what has to be equal where a render goes on, and what it went on with.
struct CheckpointOrigin {
    std::uint64_t fingerprint = 0;   ///< of the build
    std::string build;               ///< for a person
    std::uint64_t scene_hash = 0;    ///< content_hash() of the packed scene
    std::string resolved;            ///< job in TOML, as it was used
    std::string output_file;         ///< -o
    std::vector<PassPlan> schedule;  ///< passes of --schedule; none: the job's own
    std::uint64_t pixels = 0;        ///< of the image
};

/// Sections of a checkpoint. Films are named by their `stored`, which must be set, and lie in files of their own.
std::vector<Section> encode_state(const CheckpointOrigin& origin, const RenderState& state);

/// As encode_state(), but a pass in hand leaves the state: its layers, which may be gigabytes, are not copied.
std::vector<Section> take_state(const CheckpointOrigin& origin, RenderState& state);

CheckpointOrigin decode_origin(const SectionFile& file);

/// The state without the pixels of its films. Throws FormatError for what encode_state() cannot have written for an
/// image of this size and these AOVs.
RenderState decode_state(const SectionFile& file, std::size_t pixels, std::span<const AovRequest> aovs);

/// Whether a file of this name is a film's: "film-", 32 hexadecimal digits, ".tff".
bool is_film_name(const std::string& name);

/// A film's file.
Bytes encode_pixels(std::span<const PixelEstimate> pixels);
/// Throws FormatError where there are not so many pixels.
std::vector<PixelEstimate> decode_pixels(std::span<const std::uint8_t> bytes, std::size_t pixels);

}  // namespace treefarm
