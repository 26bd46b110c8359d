// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"

namespace treefarm {

/// Limits of a shot.
inline constexpr int kMostFrames = 100'000;
inline constexpr int kLastFrame = 9'999'999;

/// Frame numbers of a text as "1-24", "1-24x2" (every second one) or "1,5,9-12", in its order, each once. Throws
/// InputError at `where`.
std::vector<int> parse_frames(std::string_view text, const Location& where);

/// Whether a text contains a placeholder of the frame's number: %d, or %04d and the like.
bool names_frame(std::string_view text);
/// Text with the placeholders replaced by a frame's number: %d becomes "7", %04d "0007".
std::string for_frame(std::string_view text, int frame);

/// As names_frame(), for an output file, which may also contain ####.
bool output_names_frame(std::string_view file);
/// Name of a frame's output file: as for_frame(), and #### becomes "0007", with as many digits as signs.
std::string output_for_frame(std::string_view file, int frame);

/// Name without placeholders and their separators: "walk" of "walk.%04d".
std::string name_without_frame(std::string_view name);

/// Frame number with leading zeros, for sorted names: "0007".
std::string frame_digits(int frame, int width = 4);

}  // namespace treefarm
