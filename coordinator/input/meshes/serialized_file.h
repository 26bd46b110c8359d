// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <string>

#include "common/base/error.h"
#include "common/scene/model/shape.h"

namespace treefarm {

/// Reads mesh number `index` (from 0 on) of a file in Mitsuba's serialized format, versions 3 and 4: normals as
/// written, texture coordinates; colours are skipped. Malformed, infinite and out-of-range values throw InputError with
/// the position in the file or in the unpacked mesh. `asked_from`: location of the file's name.
Mesh read_serialized(const std::filesystem::path& path, std::int64_t index, const Location& asked_from);

/// Reads mesh number `index` from a stream of `size` bytes; `file`: name for messages.
///
///     file       := mesh* offset[count] count:u32        offset: u32 in version 3, u64 in version 4
///     mesh       := 0x041C:u16 version:u16 zlib(flags:u32 [name NUL, version 4] vertices:u64 triangles:u64
///                   positions normals? uvs? colours? indices:u32[3 * triangles])
///
/// Flags: 1 normals, 2 texture coordinates, 8 colours, 0x2000 double instead of single precision.
Mesh parse_serialized(std::istream& in, std::uint64_t size, std::int64_t index, const std::string& file);

}  // namespace treefarm
