// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coordinator/checkpoint/section_file.h"
#include "coordinator/passes/render_state.h"

namespace treefarm {

/// Origin of a checkpoint: the values that must be equal on a resume, and those that it takes over.
struct CheckpointOrigin {
    std::uint64_t fingerprint = 0;   ///< of the build
    std::string build;               ///< description of the build, for messages
    std::uint64_t scene_hash = 0;    ///< content_hash() of the packed scene
    std::string resolved;            ///< resolved job in TOML
    std::string output_file;         ///< value of -o
    std::vector<PassPlan> schedule;  ///< passes of --schedule; empty: the job's own
    std::uint64_t pixels = 0;        ///< number of the image's pixels
};

/// Sections of a checkpoint. Films are named by their `stored`, which must be set, and are in files of their own.
std::vector<Section> encode_state(const CheckpointOrigin& origin, const RenderState& state);

/// As encode_state(), but takes the partial pass out of the state: its layers, which may be gigabytes, are not copied.
std::vector<Section> take_state(const CheckpointOrigin& origin, RenderState& state);

CheckpointOrigin decode_origin(const SectionFile& file);

/// State without the pixels of its films. Throws FormatError if encode_state() cannot have written the sections for an
/// image of this size and these AOVs.
RenderState decode_state(const SectionFile& file, std::size_t pixels, std::span<const AovRequest> aovs);

/// Whether a file name is that of a film: "film-", 32 hexadecimal digits, ".tff".
bool is_film_name(const std::string& name);

/// Name of the file of a film, by its content.
std::string film_name(std::span<const std::uint8_t> bytes);
/// Content of a film's file.
Bytes encode_pixels(std::span<const PixelEstimate> pixels);
/// Pixels of a film's file. Throws FormatError if their number differs from `pixels`.
std::vector<PixelEstimate> decode_pixels(std::span<const std::uint8_t> bytes, std::size_t pixels);

}  // namespace treefarm
