// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"

namespace treefarm {

/// Content of a Wavefront OBJ file, with faces cut into triangles; nothing is merged or computed.
struct ObjFile {
    /// Indices from 0 on, or kMissing.
    struct Corner {
        static constexpr std::uint32_t kMissing = 0xffffffff;
        std::uint32_t position = kMissing, uv = kMissing, normal = kMissing;
        std::uint32_t group = 0;  ///< incremented with each change of group or material
    };

    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< as written: not normalised
    std::vector<Vec2> uvs;
    std::vector<Corner> corners;            ///< three per triangle
    std::size_t flat_faces = 0;             ///< faces of one or two corners, which are left out
    std::vector<std::string> materials;     ///< names of usemtl, each once
    std::vector<std::int32_t> material_of;  ///< per triangle: index in `materials`, or -1 before any usemtl
    std::vector<std::string> libraries;     ///< files named by mtllib; not read here
};

/// Reads an OBJ file. Malformed numbers, NaN and invalid indices throw InputError with line and column. Faces with more
/// than three corners may be concave but must be nearly flat; lines, points and curves are skipped. `asked_from`:
/// location of the file's name.
ObjFile read_obj(const std::filesystem::path& path, const Location& asked_from);

/// Parses the text of an OBJ file; `file`: name for messages.
ObjFile parse_obj(std::string_view text, const std::string& file);

}  // namespace treefarm
