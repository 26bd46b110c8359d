// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Technique that found light at the end of a path. On the wire: append only.
enum class LightFound : std::uint8_t {
    met,          ///< emission of a surface hit by scattering
    sampled,      ///< an emitter sampled by next event
    sky_met,      ///< light from infinity reached by scattering
    sky_sampled,  ///< light from infinity sampled by next event
};

/// Class of a path by the interaction that makes its light hard to find: the last one in this order that occurred.
/// Mirrors and smooth glass directly in front of the camera do not count if the path scatters behind them. On the wire:
/// append only.
enum class PathClass : std::uint8_t { diffuse, glossy, mirror, smooth_glass, rough_glass, sheet };

/// Origin of a contribution to a sample.
struct LightOrigin {
    LightFound found = LightFound::met;
    PathClass path_class = PathClass::diffuse;
    std::uint8_t vertices = 0;  ///< surfaces of the path, the emitter included; 255: at least so many

    bool operator==(const LightOrigin&) const = default;
};

/// Whether technique and class are valid values; those of a message may not be.
bool is_known(const LightOrigin& origin);

/// Description such as "light through rough glass, met by chance". It names the number of vertices only for light that
/// the camera sees directly.
std::string words(const LightOrigin& origin);

}  // namespace treefarm
