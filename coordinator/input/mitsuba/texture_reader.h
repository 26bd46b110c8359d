// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "coordinator/input/mitsuba/image_requests.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns texture elements into textures of the scene; the same element always becomes the same texture.
class TextureReader {
  public:
    TextureReader(Scene& scene, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), document_(document), diagnostics_(diagnostics) {}

    /// The property `name`: a colour, or a texture of that name.
    ColorInput color(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use);

    /// The property `name` where textures cannot be looked up: one throws InputError or, when lenient, its factor
    /// counts.
    Rgb constant(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use);

    /// The property `name`: a number, a colour (its mean), or a texture of that name.
    FloatInput number(Properties& properties, const std::string& name, float otherwise);

    /// A texture whose values are data (displacements, normals): plain, even where integers usually are sRGB, unless
    /// the element says otherwise.
    ColorInput data(const XmlElement& texture, bool signed_values);

    /// Width over height of a texture's pixels; 1 where it has none.
    double aspect(const ColorInput& input) const;

    /// An image of three linear float channels, for the environment.
    std::int32_t environment_image(Properties& properties);

    /// The images of the textures.
    const ImageRequests& images() const { return images_; }

  private:
    /// How the values of a texture are used.
    struct Use {
        ColorUse color = ColorUse::reflectance;
        bool data = false;
        bool signed_values = false;
        auto key() const { return std::tie(color, data, signed_values); }
        bool operator<(const Use& other) const { return key() < other.key(); }
    };
    ColorInput read(const XmlElement& texture, const Use& use);
    ColorInput convert(const XmlElement& texture, const Use& use);
    /// An object that stands for a spectrum; nothing for other types.
    std::optional<ColorInput> read_constant(Properties& properties, const Use& use);
    ColorInput convert_bitmap(Properties& properties, const Use& use);
    ColorInput convert_checkerboard(Properties& properties, const Use& use);
    ColorInput convert_scale(Properties& properties, const Use& use);
    ColorInput convert_mesh_attribute(Properties& properties);
    std::int32_t add(TextureKind kind, const Properties& properties);

    Scene& scene_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
    ImageRequests images_;
    std::map<std::pair<const XmlElement*, Use>, ColorInput> known_;
};

/// The file that a property names: relative to the file that the element stands in. InputError if it is missing.
std::filesystem::path file_of(Properties& properties);

}  // namespace treefarm::mitsuba
