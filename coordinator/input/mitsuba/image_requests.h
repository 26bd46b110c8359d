// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/diagnostics.h"

namespace treefarm::mitsuba {

/// Number that a coloured texel stands for: none, the mean of its channels (Mitsuba 0.6), or its luminance (the heights
/// of 0.6, everything in 2 and 3).
enum class TexelNumber : std::uint8_t { none, mean, luminance };

/// Interpretation of the values of an image file.
struct Decoding {
    static constexpr double kAuto = 0.0, kSrgb = -1.0;

    double gamma = kAuto;        ///< linear = encoded ^ gamma; kSrgb: sRGB's curve; kAuto: as the file says, else sRGB
    bool file_gamma = false;     ///< kAuto uses a PNG file's own gamma, as Mitsuba 0.6 does
    std::string channel;         ///< one channel "r", "g", "b", "a" or "y"; "": all but alpha
    Location channel_where;      ///< of that choice, for messages
    bool signed_values = false;  ///< negative floats are kept
    bool is_light = false;       ///< infinite floats become the largest half
    bool as_floats = false;      ///< three channels of linear floats, whatever the file has
    TexelNumber number = TexelNumber::none;

    auto key() const { return std::tie(gamma, file_gamma, channel, signed_values, is_light, as_floats, number); }
    bool operator<(const Decoding& other) const { return key() < other.key(); }
};

/// Images that a scene needs. Each file is read once per interpretation, and only at the end, when the used ones are
/// known.
class ImageRequests {
  public:
    /// Index in Scene::images, where an empty image is added for now. A missing file throws InputError at `where`.
    std::int32_t add(const std::filesystem::path& path, const Decoding& decoding, const Location& where, Scene& scene);

    /// Width over height of a requested image. The file is read for it, and again by read(). Throws InputError.
    double aspect(std::int32_t image) const;

    /// Reads the images that are still used; `kept`: new index of each (remove_unused). Throws InputError.
    void read(const std::vector<std::int32_t>& kept, Scene& scene, Diagnostics& diagnostics) const;

  private:
    struct Request {
        std::filesystem::path path;
        Decoding decoding;
        Location where;
        std::int32_t image;
    };
    std::vector<Request> requests_;
    std::map<std::pair<std::filesystem::path, Decoding>, std::int32_t> known_;
};

}  // namespace treefarm::mitsuba
