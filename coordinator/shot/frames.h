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

/// Frame numbers from a text as "1-24", "1-24x2" (every second one) or "1,5,9-12", in its order, each once. Throws
/// InputError at `where`.
std::vector<int> parse_frames(std::string_view text, const Location& where);

/// Whether a text holds %d, or %04d and the like, which stand for a frame's number.
bool names_frame(std::string_view text);
/// The text with the number of a frame in these places: %d becomes "7", %04d "0007".
std::string for_frame(std::string_view text, int frame);

/// names_frame() of an output file, which may also hold ####.
bool output_names_frame(std::string_view file);
/// The name of a frame's output file: as for_frame(), and #### becomes "0007", with as many digits as there are signs.
std::string output_for_frame(std::string_view file, int frame);

/// A name without its marks for frames and what divides them from the rest: "walk" of "walk.%04d".
std::string name_without_frame(std::string_view name);

/// "0007": a frame's number where names are sorted.
std::string frame_digits(int frame, int width = 4);

}  // namespace treefarm
