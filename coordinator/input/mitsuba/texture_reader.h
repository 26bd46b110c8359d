// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "coordinator/input/mitsuba/image_requests.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns texture elements into textures of the scene; equal elements become the same texture.
class TextureReader {
  public:
    TextureReader(Scene& scene, const SceneDocument& document, Diagnostics& diagnostics)
        : scene_(scene), document_(document), diagnostics_(diagnostics) {}

    /// Colour from the property `name`: a colour, or a texture.
    ColorInput color(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use);

    /// Colour from the property `name` for uses without textures: a texture throws InputError or, when lenient, only
    /// its factor is used.
    Rgb constant(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use);

    /// Number from the property `name`: a number, a colour, or a texture. Of colours the number is the mean of the
    /// channels in version 0, else the luminance.
    FloatInput number(Properties& properties, const std::string& name, float otherwise);

    /// Textures with values that are data: integers are linear, not sRGB, unless the element says otherwise. Heights
    /// are luminances, and may be negative.
    ColorInput heights(const XmlElement& texture);
    ColorInput normals(const XmlElement& texture);

    /// Width over height of a texture's pixels; 1 for textures without pixels.
    double aspect(const ColorInput& input) const;

    /// Image of three linear float channels, for the environment.
    std::int32_t environment_image(Properties& properties);

    /// Images of the textures.
    const ImageRequests& images() const { return images_; }

  private:
    /// Use of a texture's values.
    struct Use {
        ColorUse color = ColorUse::reflectance;
        bool data = false;
        bool signed_values = false;
        TexelNumber number = TexelNumber::none;
        auto key() const { return std::tie(color, data, signed_values, number); }
        bool operator<(const Use& other) const { return key() < other.key(); }
    };
    ColorInput read(const XmlElement& texture, const Use& use);
    ColorInput convert(const XmlElement& texture, const Use& use);
    /// Colour of an object that stands for a spectrum; empty for other types.
    std::optional<ColorInput> read_constant(Properties& properties, const Use& use);
    ColorInput convert_bitmap(Properties& properties, const Use& use);
    ColorInput convert_checkerboard(Properties& properties, const Use& use);
    static ColorUse scaled_as_whole(const Use& use);
    ColorInput convert_grid(Properties& properties, const Use& use);
    ColorInput convert_wireframe(Properties& properties, const Use& use);
    ColorInput convert_scale(Properties& properties, const Use& use);
    ColorInput convert_mesh_attribute(Properties& properties);
    std::int32_t add(TextureKind kind, const Properties& properties);

    Scene& scene_;
    const SceneDocument& document_;
    Diagnostics& diagnostics_;
    ImageRequests images_;
    std::map<std::pair<const XmlElement*, Use>, ColorInput> known_;
};

/// Gives wireframes of line width 0 a tenth of the mean edge of the meshes that use them, as Mitsuba 0.6 does for the
/// first of these.
void choose_line_widths(Scene& scene);

/// File named by a property, relative to the element's file. Throws InputError if it is missing.
std::filesystem::path file_of(Properties& properties);

}  // namespace treefarm::mitsuba
