// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// How light was found at the end of a path. On the wire: append only.
enum class LightFound : std::uint8_t {
    met,          ///< emission of a surface that scattering has met
    sampled,      ///< an emitter sampled by next event
    sky_met,      ///< light from infinity that scattering has met
    sky_sampled,  ///< light from infinity sampled by next event
};

/// What a path has passed, as far as that makes light hard to find: the last in this order that it did. What the camera
/// sees by way of mirrors and smooth glass alone does not count, if the path scatters behind that. On the wire: append
/// only.
enum class PathClass : std::uint8_t { diffuse, glossy, mirror, smooth_glass, rough_glass, sheet };

/// Where a contribution to a sample comes from.
struct LightOrigin {
    LightFound found = LightFound::met;
    PathClass path_class = PathClass::diffuse;
    std::uint8_t vertices = 0;  ///< surfaces of the path, the emitter included; 255: as many or more

    bool operator==(const LightOrigin&) const = default;
};

/// Whether it is one of those above: a message may say anything.
bool is_known(const LightOrigin& origin);

/// An origin in words, without the number of vertices but for light that the camera itself sees: "light through rough
/// glass, met by chance".
std::string words(const LightOrigin& origin);

}  // namespace treefarm
