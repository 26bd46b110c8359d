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

/// Frame numbers of a text such as "1-24", "1-24x2" (every second) or "1,5,9-12", in the given order, without
/// repetition. Throws InputError at `where`.
std::vector<int> parse_frames(std::string_view text, const Location& where);

/// Whether a text has a placeholder of the frame number: %d, %04d or the like.
bool names_frame(std::string_view text);
/// The text with each placeholder replaced by the frame number: %d by "7", %04d by "0007".
std::string for_frame(std::string_view text, int frame);

/// names_frame() for the name of an output file, in which #### is a placeholder, too; not in its folders' names.
bool output_names_frame(std::string_view file);
/// Path of a frame's output file: for_frame(), with #### in the file's name replaced by "0007", one digit for each #.
std::string output_for_frame(std::string_view file, int frame);

/// Name without placeholders and the separators next to them: "walk" for "walk.%04d".
std::string name_without_frame(std::string_view name);

/// Frame number with leading zeros, so that names sort: "0007".
std::string frame_digits(int frame, int width = 4);

}  // namespace treefarm
