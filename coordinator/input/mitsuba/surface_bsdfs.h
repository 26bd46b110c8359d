// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "common/scene/model/material.h"
#include "coordinator/input/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// The BSDFs that are a kind of surface, with the defaults of the version of the format; a coating yet without what it
/// coats. Nothing for other types.
std::optional<decltype(Material::bsdf)> read_surface_bsdf(Properties& properties, TextureReader& textures,
                                                          const SceneDocument& document, Diagnostics& diagnostics);

/// The types that read_surface_bsdf() knows.
std::vector<std::string_view> surface_bsdf_names();

}  // namespace treefarm::mitsuba
