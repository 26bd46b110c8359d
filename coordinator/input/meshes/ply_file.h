// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/scene/model/shape.h"

namespace treefarm {

/// Reads a PLY file (ascii, binary of either byte order): the mesh of its elements "vertex" and "face", faces cut into
/// triangles. Vertices may have normals nx, ny, nz, as written, and texture coordinates u, v or s, t or texture_u,
/// texture_v; everything else is skipped. What is malformed, not finite or out of range throws InputError: at its line
/// and column in the header and in text, with its byte in binary data. `asked_from` is where the file's name stands.
Mesh read_ply(const std::filesystem::path& path, const Location& asked_from);

/// Reads a PLY file's bytes; `file` is the name for messages.
Mesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace treefarm
