// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/scene/model/shape.h"

namespace treefarm {

/// Reads a PLY file (ascii, or binary of either byte order): the mesh of its elements "vertex" and "face", faces cut
/// into triangles. Vertices may have normals nx, ny, nz, as written, and texture coordinates u, v or s, t or texture_u,
/// texture_v; other properties are skipped. Malformed, infinite and out-of-range values throw InputError: with line and
/// column in the header and in text, with the byte offset in binary data. `asked_from`: location of the file's name.
Mesh read_ply(const std::filesystem::path& path, const Location& asked_from);

/// Parses a PLY file's bytes; `file`: name for messages.
Mesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace treefarm
