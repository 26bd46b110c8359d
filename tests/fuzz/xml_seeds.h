// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace treefarm::fuzz {

/// Small scenes in both dialects that together use what the reader knows. They name the files part.xml, t.png, m.ply,
/// m.obj, m.serialized, s.spd, e.hdr and e.exr.
std::vector<std::string> xml_seeds();

/// part.xml: what the seeds include.
inline constexpr char kIncludedPart[] =
    "<scene version=\"0.6.0\"><default name=\"grey\" value=\"0.4\"/><bsdf type=\"diffuse\" id=\"included\">"
    "<rgb name=\"reflectance\" value=\"$grey\"/></bsdf></scene>";

}  // namespace treefarm::fuzz
