// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"

namespace treefarm {

/// Supported properties of a material in an MTL file.
struct MtlMaterial {
    std::string name;
    Rgb diffuse{0.8f};         ///< Kd, linear
    Rgb specular{0.0f};        ///< Ks, linear
    bool has_specular = true;  ///< false for illum 0 and 1, whatever Ks is
    double exponent = 0.0;     ///< Ns, of Phong's lobe
    Rgb emission{0.0f};        ///< Ke: radiance
    std::string diffuse_map;   ///< map_Kd: a file name as written, or ""
    Location where;            ///< of newmtl
    Location diffuse_map_where;
};

/// Reads the materials of an MTL file: newmtl, Kd, Ks, Ns, Ke, illum and map_Kd; other statements are skipped.
/// Malformed numbers throw InputError with line and column. `asked_from`: location of the file's name.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& path, const Location& asked_from);

/// Parses the text of an MTL file; `file`: name for messages.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& file);

}  // namespace treefarm
