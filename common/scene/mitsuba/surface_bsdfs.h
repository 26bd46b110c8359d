// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/scene/material.h"
#include "common/scene/mitsuba/texture_reader.h"

namespace treefarm::mitsuba {

/// The BSDFs that hold no other one: diffuse, (rough)conductor, (thin, rough)dielectric, (rough)plastic and null, with
/// the defaults of the version of the format. Nothing for other types.
std::optional<decltype(Material::bsdf)> read_surface_bsdf(Properties& properties, TextureReader& textures,
                                                          Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
