// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/texture_reader.h"

#include <algorithm>
#include <iterator>
#include <span>

#include "common/base/text/parse_text.h"
#include "common/scene/uses/mesh_attribute_uses.h"
#include "coordinator/input/mitsuba/spectrum_plugins.h"

namespace treefarm::mitsuba {
namespace {

/// Textures of version 0, and of later ones, where spectra are objects, too.
constexpr std::string_view kOldTextures[] = {"bitmap",      "checkerboard", "scale",
                                             "gridtexture", "vertexcolors", "wireframe"};
constexpr std::string_view kTextures[] = {"bitmap", "checkerboard", "scale",   "uniform",   "rawconstant",   "srgb",
                                          "d65",    "irregular",    "regular", "blackbody", "mesh_attribute"};

Wrap read_wrap(const std::string& word, const Location& where) {
    if (word == "repeat") return Wrap::repeat;
    if (word == "mirror") return Wrap::mirror;
    if (word == "clamp") return Wrap::clamp;
    if (word == "zero" || word == "black") return Wrap::zero;
    if (word == "one" || word == "white") return Wrap::one;
    throw InputError(where, "unknown wrap mode " + in_quotes(word), "use repeat, mirror, clamp, zero or one");
}

/// Scale and offset of version 0.6, or the matrix of later versions.
UvTransform read_uv_transform(Properties& properties) {
    UvTransform uv;
    if (properties.element().version >= 2) {
        const Matrix m = properties.transform("to_uv");
        const auto row = [&](int i) {
            return Vec3(static_cast<float>(m[0][i]), static_cast<float>(m[1][i]), static_cast<float>(m[3][i]));
        };
        return {row(0), row(1)};
    }
    const double scale = properties.number("uvscale", 1.0);
    uv.u_row = Vec3(static_cast<float>(properties.number("uscale", scale)), 0.0f,
                    static_cast<float>(properties.number("uoffset", 0.0)));
    uv.v_row = Vec3(0.0f, static_cast<float>(properties.number("vscale", scale)),
                    static_cast<float>(properties.number("voffset", 0.0)));
    if (const std::string coordinates = properties.text("coordinates", "uv"); coordinates != "uv")
        throw InputError(properties.where("coordinates"), "unknown texture coordinates " + in_quotes(coordinates),
                         "use uv");
    return uv;
}

/// Number that a colour stands for; grey keeps its bits.
float as_number(const Rgb& color, bool mean) {
    return mean || (color.x == color.y && color.y == color.z) ? average(color) : luminance(color);
}

bool read_filter(Properties& properties) {
    const std::string filter = properties.text("filter_type", "bilinear");
    if (filter == "nearest") return false;
    if (filter != "bilinear" && filter != "trilinear" && filter != "ewa")
        throw InputError(properties.where("filter_type"), "unknown filter " + in_quotes(filter),
                         "use nearest, bilinear, trilinear or ewa");
    return true;
}

}  // namespace

void choose_line_widths(Scene& scene) {
    const auto is_open = [](const Texture& texture) {
        const auto* wires = std::get_if<WireframeTexture>(&texture.kind);
        return wires && wires->line_width == 0.0f;
    };
    if (std::none_of(scene.textures.begin(), scene.textures.end(), is_open)) return;
    const std::vector<std::set<std::int32_t>> uses = textures_of_shapes(scene);
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        if (!is_open(scene.textures[i])) continue;
        double sum = 0.0;
        std::size_t edges = 0;
        for (std::size_t s = 0; s < uses.size(); ++s) {
            const auto* mesh = std::get_if<Mesh>(&scene.shapes[s].geometry);
            if (!mesh || !uses[s].contains(static_cast<std::int32_t>(i))) continue;
            const auto& at = mesh->indices;
            for (std::size_t corner = 0; corner < at.size(); ++corner) {
                const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
                sum += double((mesh->positions[at[next]] - mesh->positions[at[corner]]).length());
            }
            edges += at.size();
        }
        if (edges > 0)
            std::get<WireframeTexture>(scene.textures[i].kind).line_width =
                static_cast<float>(0.1 * sum / static_cast<double>(edges));
    }
}

std::filesystem::path file_of(Properties& properties) {
    if (!properties.has("filename"))
        throw InputError(properties.where(), properties.title() + " has no file name",
                         R"(add <string name="filename" value="..."/>)");
    return properties.text("filename", "");
}

/// Use of a colour in a texture of Mitsuba 0.6, which scales a texture that exceeds 1 as a whole
/// (validate_materials.cpp).
ColorUse TextureReader::scaled_as_whole(const Use& use) {
    return use.color == ColorUse::reflectance ? ColorUse::coefficient : use.color;
}

ColorInput TextureReader::color(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use) {
    if (const XmlElement* texture = properties.named_child("texture", name)) return read(*texture, {use});
    return properties.color(name, otherwise, use);
}

Rgb TextureReader::constant(Properties& properties, const std::string& name, const Rgb& otherwise, ColorUse use) {
    const ColorInput input = color(properties, name, otherwise, use);
    if (input.varies())
        diagnostics_.unsupported(
            properties.where(name),
            "a textured " + in_quotes(name) + " of " + properties.title() + " is not available in this version",
            "give a colour", "its factor alone is used");
    return input.value;
}

FloatInput TextureReader::number(Properties& properties, const std::string& name, float otherwise) {
    ColorInput input;
    const bool mean = properties.element().version < 2;
    if (const XmlElement* texture = properties.named_child("texture", name)) {
        input =
            read(*texture, {ColorUse::coefficient, false, false, mean ? TexelNumber::mean : TexelNumber::luminance});
    } else if (const std::string tag = properties.tag_of(name); tag != "rgb" && tag != "srgb" && tag != "spectrum") {
        return static_cast<float>(properties.number(name, double(otherwise)));
    } else {
        input.value = properties.color(name, Rgb(otherwise), ColorUse::coefficient);
    }
    if (input.value.x != input.value.y || input.value.y != input.value.z)
        diagnostics_.warn(properties.where(name),
                          in_quotes(name) + " of " + properties.title() +
                              " is coloured: " + (mean ? "the mean of its channels" : "its luminance") + " is used");
    return {as_number(input.value, mean), input.texture};
}

ColorInput TextureReader::heights(const XmlElement& texture) {
    return read(texture, {ColorUse::coefficient, true, true, TexelNumber::luminance});
}

ColorInput TextureReader::normals(const XmlElement& texture) {
    return read(texture, {ColorUse::coefficient, true, false});
}

double TextureReader::aspect(const ColorInput& input) const {
    if (!input.varies()) return 1.0;
    const auto* bitmap = std::get_if<BitmapTexture>(&scene_.textures[static_cast<std::size_t>(input.texture)].kind);
    return bitmap ? images_.aspect(bitmap->image) : 1.0;
}

std::int32_t TextureReader::environment_image(Properties& properties) {
    Decoding decoding;
    decoding.gamma = properties.element().version == 0 ? properties.number("gamma", Decoding::kAuto) : Decoding::kAuto;
    decoding.file_gamma = properties.element().version == 0;
    decoding.is_light = decoding.as_floats = true;
    const std::filesystem::path path = file_of(properties);
    return images_.add(path, decoding, properties.where("filename"), scene_);
}

ColorInput TextureReader::read(const XmlElement& texture, const Use& use) {
    const auto known = known_.find({&texture, use});
    if (known != known_.end()) return known->second;
    ColorInput input = convert(texture, use);
    known_.emplace(std::pair(&texture, use), input);
    return input;
}

ColorInput TextureReader::convert(const XmlElement& texture, const Use& use) {
    Properties properties(texture, document_, diagnostics_);
    const std::string type = properties.type();
    const bool is_old = properties.element().version < 2;
    ColorInput input(Rgb(0.5f));
    if (type == "bitmap") {
        input = convert_bitmap(properties, use);
    } else if (type == "checkerboard") {
        input = convert_checkerboard(properties, use);
    } else if (type == "gridtexture" && is_old) {
        input = convert_grid(properties, use);
    } else if (type == "wireframe" && is_old) {
        input = convert_wireframe(properties, use);
    } else if (type == "vertexcolors" && is_old) {
        input = {Rgb(1.0f), add(MeshAttributeTexture{"vertex_color"}, properties)};
    } else if (type == "scale") {
        input = convert_scale(properties, use);
    } else if (type == "mesh_attribute" && !is_old) {
        input = convert_mesh_attribute(properties);
    } else if (const auto constant = read_constant(properties, use)) {
        input = *constant;
    } else {
        const auto known_types =
            is_old ? std::span<const std::string_view>(kOldTextures) : std::span<const std::string_view>(kTextures);
        diagnostics_.unsupported(texture.where, "the texture " + in_quotes(type) + " is not available in this version",
                                 did_you_mean(type, known_types, "use bitmap, checkerboard or scale"), "0.5 is used");
        return input;
    }
    properties.finish();
    return input;
}

std::optional<ColorInput> TextureReader::read_constant(Properties& properties, const Use& use) {
    if (properties.element().version < 2) return std::nullopt;
    // A texture under D65: in Rec. 709 that is the texture itself.
    const XmlElement* lit = properties.type() == "d65" ? properties.only_child("texture") : nullptr;
    if (lit == nullptr) {
        if (const auto color = read_spectrum_plugin(properties, use.color, diagnostics_)) return ColorInput(*color);
        return std::nullopt;
    }
    ColorInput nested = read(*lit, use);
    nested.value *= static_cast<float>(properties.number("scale", 1.0));
    return nested;
}

std::int32_t TextureReader::add(TextureKind kind, const Properties& properties) {
    scene_.textures.push_back({std::move(kind), properties.id(), properties.where()});
    return static_cast<std::int32_t>(scene_.textures.size() - 1);
}

ColorInput TextureReader::convert_bitmap(Properties& properties, const Use& use) {
    const bool is_old = properties.element().version < 2;
    Decoding decoding;
    decoding.signed_values = use.signed_values;
    decoding.is_light = use.color == ColorUse::radiance;
    decoding.number = use.number;
    if (is_old) {
        decoding.file_gamma = true;
        if (use.data && !properties.has("gamma"))
            diagnostics_.warn(properties.where(),
                              "a bump or normal map does not say its gamma: it is read as linear (gamma 1), which "
                              "most of them are");
        decoding.gamma = properties.number("gamma", use.data ? 1.0 : Decoding::kAuto);
        if (!(decoding.gamma >= 0.0 && decoding.gamma <= 100.0) && decoding.gamma != Decoding::kSrgb)
            throw InputError(properties.where("gamma"), "a gamma of " + number_text(decoding.gamma),
                             "give a positive number, -1 for sRGB, or leave it out");
        decoding.channel = properties.text("channel", "");
        decoding.channel_where = properties.where("channel");
        for (char& c : decoding.channel)
            c = static_cast<char>('A' <= c && c <= 'Z' ? c - 'A' + 'a' : c);
        properties.ignore({"cache", "max_anisotropy"});
    } else {
        if (properties.boolean("raw", false))
            decoding.gamma = 1.0;
        else if (use.data)
            diagnostics_.warn(properties.where(),
                              "this bump or normal map is decoded as sRGB, as Mitsuba does it: most want raw=true");
        properties.ignore({"format", "accel"});
    }
    BitmapTexture bitmap;
    bitmap.bilinear = read_filter(properties);
    const std::string wrap = properties.text("wrap_mode", "repeat");
    const auto where_of = [&](const char* name) { return properties.where(properties.has(name) ? name : "wrap_mode"); };
    bitmap.wrap_u = read_wrap(properties.text("wrap_mode_u", wrap), where_of("wrap_mode_u"));
    bitmap.wrap_v = read_wrap(properties.text("wrap_mode_v", wrap), where_of("wrap_mode_v"));
    bitmap.uv = read_uv_transform(properties);
    const std::filesystem::path path = file_of(properties);
    bitmap.image = images_.add(path, decoding, properties.where("filename"), scene_);
    return {Rgb(1.0f), add(bitmap, properties)};
}

ColorInput TextureReader::convert_checkerboard(Properties& properties, const Use& use) {
    CheckerboardTexture board;
    for (const auto& [name, color] : {std::pair("color0", &board.color0), std::pair("color1", &board.color1)}) {
        *color =
            constant(properties, name, *color, properties.element().version < 2 ? scaled_as_whole(use) : use.color);
        const bool grey = color->x == color->y && color->y == color->z;
        if (use.number == TexelNumber::luminance && !grey) *color = Rgb(luminance(*color));
    }
    board.uv = read_uv_transform(properties);
    // If Mitsuba 3 evaluates a checkerboard as one number (eval_1 in its checkerboard.cpp), the squares are exchanged.
    if (properties.element().version >= 2 && use.color == ColorUse::coefficient && !use.data)
        std::swap(board.color0, board.color1);
    if (properties.element().version < 2) properties.ignore({"filter_type", "cache"});
    return {Rgb(1.0f), add(board, properties)};
}

ColorInput TextureReader::convert_grid(Properties& properties, const Use& use) {
    GridTexture grid;
    for (const auto& [name, color] : {std::pair("color0", &grid.color0), std::pair("color1", &grid.color1)})
        *color = constant(properties, name, *color, scaled_as_whole(use));
    grid.line_width = static_cast<float>(properties.number("line_width", 0.01));
    grid.uv = read_uv_transform(properties);
    properties.ignore({"filter_type", "cache"});
    return {Rgb(1.0f), add(grid, properties)};
}

ColorInput TextureReader::convert_wireframe(Properties& properties, const Use& use) {
    WireframeTexture wires;
    wires.edge = constant(properties, "edge_color", wires.edge, scaled_as_whole(use));
    wires.interior = constant(properties, "interior_color", wires.interior, scaled_as_whole(use));
    wires.line_width = static_cast<float>(properties.number("line_width", 0.0));
    wires.step_width = static_cast<float>(std::clamp(properties.number("step_width", 0.5), 0.0, 1.0));
    return {Rgb(1.0f), add(wires, properties)};
}

ColorInput TextureReader::convert_mesh_attribute(Properties& properties) {
    const std::string name = properties.text("name", "");
    if (!name.starts_with("vertex_") && !name.starts_with("face_"))
        throw InputError(properties.has("name") ? properties.where("name") : properties.where(),
                         "a mesh attribute is named " + in_quotes(name),
                         "begin its name with vertex_ or face_, as vertex_color");
    const auto scale = static_cast<float>(properties.number("scale", 1.0));
    return {Rgb(scale), add(MeshAttributeTexture{name}, properties)};
}

ColorInput TextureReader::convert_scale(Properties& properties, const Use& use) {
    const Rgb scale =
        properties.color("scale", Rgb(1.0f), use.signed_values ? ColorUse::factor : ColorUse::coefficient);
    ColorInput nested;
    const XmlElement* texture = properties.only_child("texture");
    if (texture != nullptr)
        nested = read(*texture, use);
    else if (properties.has("value"))
        nested.value = properties.color("value", Rgb(1.0f), ColorUse::coefficient);
    else
        throw InputError(properties.where(), properties.title() + " has no texture inside", "put one into it");
    nested.value *= scale;
    return nested;
}

}  // namespace treefarm::mitsuba
