// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "common/scene/model/material.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// Reads a BSDF that is a kind of surface, with the defaults of the format's version; a coating is returned without its
/// coated material. Empty for other types.
std::optional<decltype(Material::bsdf)> read_surface_bsdf(Properties& properties, TextureReader& textures,
                                                          const SceneDocument& document, Diagnostics& diagnostics);

/// Types that read_surface_bsdf() supports.
std::vector<std::string_view> surface_bsdf_names();

}  // namespace treefarm::mitsuba
