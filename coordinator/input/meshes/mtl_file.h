// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"

namespace treefarm {

/// A material of an MTL file, as far as it is read.
struct MtlMaterial {
    std::string name;
    Rgb diffuse{0.8f};         ///< Kd, linear
    Rgb specular{0.0f};        ///< Ks, linear
    bool has_specular = true;  ///< illum 0 and 1: not, whatever Ks says
    double exponent = 0.0;     ///< Ns, of Phong's lobe
    Rgb emission{0.0f};        ///< Ke: radiance
    std::string diffuse_map;   ///< map_Kd: a file name as written, or ""
    Location where;            ///< of newmtl
    Location diffuse_map_where;
};

/// Reads the materials of an MTL file: newmtl, Kd, Ks, Ns, Ke, illum and map_Kd; other statements are skipped.
/// Malformed numbers throw InputError at their line and column. `asked_from` is where the file's name stands.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& path, const Location& asked_from);

/// Reads the text of an MTL file; `file` is the name for messages.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& file);

}  // namespace treefarm
