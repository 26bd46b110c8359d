// SPDX-License-Identifier: Apache-2.0
#include "worker/textures/texture_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/prefetch.h"

namespace treefarm {
namespace {

Vec2 transformed(const UvTransform& t, const Vec2& uv) {
    return {t.u_row.x * uv.x + t.u_row.y * uv.y + t.u_row.z, t.v_row.x * uv.x + t.v_row.y * uv.y + t.v_row.z};
}

/// Coordinates clamped to where floats have fractions; NaN becomes 0.
float bounded(float x) {
    constexpr float kLargest = 0x1p22f;
    return x > -kLargest && x < kLargest ? x : 0.0f;
}

/// Index of a texel after wrapping; -1 for Wrap::zero and -2 for Wrap::one outside.
int wrapped(int i, int size, Wrap wrap) {
    if (i >= 0 && i < size) return i;
    switch (wrap) {
        case Wrap::repeat:
            i %= size;
            return i < 0 ? i + size : i;
        case Wrap::mirror:
            i %= 2 * size;
            if (i < 0) i += 2 * size;
            return i < size ? i : 2 * size - 1 - i;
        case Wrap::clamp:
            return i < 0 ? 0 : size - 1;
        case Wrap::zero:
            return -1;
        case Wrap::one:
            return -2;
    }
    return 0;
}

Rgb wrapped_texel(const TextureImage& image, const BitmapTexture& bitmap, int x, int y) {
    x = wrapped(x, image.width, bitmap.wrap_u);
    y = wrapped(y, image.height, bitmap.wrap_v);
    if (x < 0 || y < 0) return Rgb(std::min(x, y) == -1 ? 0.0f : 1.0f);
    return texel(image, x, y);
}

/// Position of texture coordinates, in texels from the upper left corner.
Vec2 texel_position(const TextureImage& image, const BitmapTexture& bitmap, const Vec2& at) {
    const Vec2 uv = transformed(bitmap.uv, at);
    // Whole periods are subtracted first if the texture repeats, so that large coordinates keep their fraction.
    const auto position = [](float x, int size, Wrap wrap) {
        x = bounded(x);
        if (wrap == Wrap::repeat) x -= std::floor(x);
        const float scaled = x * static_cast<float>(size);
        return scaled > -0x1p30f && scaled < 0x1p30f ? scaled : (scaled > 0.0f ? 0x1p30f : -0x1p30f);
    };
    return {position(uv.x, image.width, bitmap.wrap_u), position(uv.y, image.height, bitmap.wrap_v)};
}

Rgb look_up(const TextureImage& image, const BitmapTexture& bitmap, const Vec2& at) {
    const Vec2 position = texel_position(image, bitmap, at);
    const float x = position.x, y = position.y;
    if (!bitmap.bilinear)
        return wrapped_texel(image, bitmap, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left, fy = y - 0.5f - top;
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    const Rgb upper =
        wrapped_texel(image, bitmap, x0, y0) * (1.0f - fx) + wrapped_texel(image, bitmap, x0 + 1, y0) * fx;
    const Rgb lower =
        wrapped_texel(image, bitmap, x0, y0 + 1) * (1.0f - fx) + wrapped_texel(image, bitmap, x0 + 1, y0 + 1) * fx;
    return upper * (1.0f - fy) + lower * fy;
}

bool in_upper_half(float x) {
    x = bounded(x);
    return x - std::floor(x) >= 0.5f;
}

/// Value of a texture without an image: needs an overload for each kind, or it does not compile.
Rgb procedural(const CheckerboardTexture& board, const TexturePoint& point) {
    const Vec2 at = transformed(board.uv, point.uv);
    return in_upper_half(at.x) == in_upper_half(at.y) ? board.color0 : board.color1;
}
Rgb procedural(const GridTexture& grid, const TexturePoint& point) {
    const Vec2 at = transformed(grid.uv, point.uv);
    const auto on_line = [&](float x) {
        x = bounded(x);
        x -= std::floor(x);
        return std::min(x, 1.0f - x) < grid.line_width;
    };
    return on_line(at.x) || on_line(at.y) ? grid.color1 : grid.color0;
}
Rgb procedural(const WireframeTexture& wires, const TexturePoint& point) {
    if (!point.on_mesh || !point.on_mesh->mesh) return wires.interior;
    const MeshPoint& at = *point.on_mesh;
    const std::uint32_t* corner = at.mesh->indices.data() + 3 * std::size_t(at.triangle);
    const Vec3 &v0 = at.mesh->positions[corner[0]], e1 = at.mesh->positions[corner[1]] - v0,
               e2 = at.mesh->positions[corner[2]] - v0;
    const Vec3 p = e1 * at.b1 + e2 * at.b2;  // from v0
    float least = std::numeric_limits<float>::infinity();
    for (const auto& [from, edge] : {std::pair(Vec3(0.0f), e1), std::pair(Vec3(0.0f), e2), std::pair(e1, e2 - e1)}) {
        const Vec3 across = cross(p - from, edge);
        least = std::min(least, dot(across, across) / dot(edge, edge));
    }
    const float begin = wires.line_width * (1.0f - wires.step_width), distance = std::sqrt(least);
    if (!(distance > begin)) return wires.edge;
    if (distance >= wires.line_width) return wires.interior;
    const float x = (distance - begin) / (wires.line_width - begin);
    return wires.edge + (wires.interior - wires.edge) * (x * x * (3.0f - 2.0f * x));
}
Rgb procedural(const BitmapTexture&, const TexturePoint&) {
    return Rgb(0.0f);  // looked up before
}
Rgb procedural(const MeshAttributeTexture&, const TexturePoint&) {
    return Rgb(0.0f);  // interpolated before
}

/// Values of an attribute at the corners of a triangle; black without a mesh, which check_mesh_attributes() rules out.
std::array<Rgb, 3> corner_values(const AttributeSlot& slot, const MeshPoint* at) {
    constexpr std::array<Rgb, 3> kNothing{Rgb(0.0f), Rgb(0.0f), Rgb(0.0f)};
    if (!at || !at->mesh || slot.index >= at->mesh->attributes.size()) return kNothing;
    const std::vector<Rgb>& values = at->mesh->attributes[slot.index].values;
    if (values.empty()) return kNothing;
    if (slot.of_faces) return {values[at->triangle], values[at->triangle], values[at->triangle]};
    const std::uint32_t* corner = at->mesh->indices.data() + 3 * std::size_t(at->triangle);
    return {values[corner[0]], values[corner[1]], values[corner[2]]};
}

Rgb interpolated(const AttributeSlot& slot, const MeshPoint* at) {
    const auto [a, b, c] = corner_values(slot, at);
    if (a == b && a == c) return a;
    return a * (1.0f - at->b1 - at->b2) + b * at->b1 + c * at->b2;
}

/// Derivative of a linear attribute by texture coordinates; 0 if these do not span a plane.
Vec2 gradient_over(const AttributeSlot& slot, const MeshPoint* at) {
    const auto [a, b, c] = corner_values(slot, at);
    const double along1 = double(average(b)) - double(average(a)), along2 = double(average(c)) - double(average(a));
    if (along1 == 0.0 && along2 == 0.0) return Vec2(0.0f);
    if (at->mesh->uvs.empty()) return Vec2(float(along1), float(along2));
    const std::uint32_t* corner = at->mesh->indices.data() + 3 * std::size_t(at->triangle);
    const Imath::V2d uv(at->mesh->uvs[corner[0]]);
    const Imath::V2d e1 = Imath::V2d(at->mesh->uvs[corner[1]]) - uv, e2 = Imath::V2d(at->mesh->uvs[corner[2]]) - uv;
    const double area = e1.cross(e2);
    if (!(std::abs(area) > 1e-30)) return Vec2(0.0f);
    return Vec2(float((along1 * e2.y - along2 * e1.y) / area), float((along2 * e1.x - along1 * e2.x) / area));
}

/// Index of a texel's first value.
std::size_t offset_of(const TextureImage& image, int x, int y) {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(image.channels);
}

}  // namespace

void prefetch_texel(const TextureImage& image, int x, int y) {
    const std::size_t at = offset_of(image, x, y);
    if (image.bytes.empty())
        prefetch_line(&image.floats[at]);
    else
        prefetch_line(&image.bytes[at]);
}

Rgb texel(const TextureImage& image, int x, int y) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t at = offset_of(image, x, y);
    if (!image.bytes.empty()) {
        const std::uint8_t* p = &image.bytes[at];
        if (channels == 1) return Rgb(image.decode[p[0]]);
        return {image.decode[p[0]], image.decode[p[1]], image.decode[p[2]]};
    }
    const float* p = &image.floats[at];
    if (channels == 1) return Rgb(p[0]);
    return {p[0], p[1], p[2]};
}

TextureSet::TextureSet(std::vector<Texture> textures, std::vector<TextureImage> images)
    : textures_(std::move(textures)), images_(std::move(images)) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const auto* texture = std::get_if<MeshAttributeTexture>(&textures_[i].kind);
        reads_meshes_ = reads_meshes_ || std::holds_alternative<WireframeTexture>(textures_[i].kind);
        if (!texture) continue;
        reads_meshes_ = true;
        const auto found = std::find(attribute_names_.begin(), attribute_names_.end(), texture->name);
        const auto index = static_cast<std::uint32_t>(found - attribute_names_.begin());
        if (found == attribute_names_.end()) attribute_names_.push_back(texture->name);
        slots_.resize(textures_.size());
        slots_[i] = {index, MeshAttribute::is_of_faces(texture->name)};
    }
}

std::vector<Shape> TextureSet::arranged(std::vector<Shape> shapes) const {
    for (Shape& shape : shapes) {
        auto* mesh = std::get_if<Mesh>(&shape.geometry);
        if (!mesh || mesh->attributes.empty()) continue;
        std::vector<MeshAttribute> found = std::exchange(mesh->attributes, {});
        for (const std::string& name : attribute_names_) {
            const auto at = std::find_if(found.begin(), found.end(),
                                         [&](const MeshAttribute& attribute) { return attribute.name == name; });
            mesh->attributes.push_back(at == found.end() ? MeshAttribute{name, {}} : std::move(*at));
        }
    }
    return shapes;
}

Rgb TextureSet::color(std::int32_t texture, const TexturePoint& at) const {
    const TextureKind& kind = textures_[static_cast<std::size_t>(texture)].kind;
    if (const auto* bitmap = std::get_if<BitmapTexture>(&kind))
        return look_up(images_[static_cast<std::size_t>(bitmap->image)], *bitmap, at.uv);
    if (std::holds_alternative<MeshAttributeTexture>(kind))
        return interpolated(slots_[static_cast<std::size_t>(texture)], at.on_mesh);
    return std::visit([&](const auto& other) { return procedural(other, at); }, kind);
}

void TextureSet::prefetch(std::int32_t texture, const Vec2& uv) const {
    const auto* bitmap = std::get_if<BitmapTexture>(&textures_[static_cast<std::size_t>(texture)].kind);
    if (!bitmap) return;
    const TextureImage& image = images_[static_cast<std::size_t>(bitmap->image)];
    const Vec2 position = texel_position(image, *bitmap, uv);
    const int x = static_cast<int>(std::floor(position.x)), y = static_cast<int>(std::floor(position.y - 0.5f));
    if (x < 0 || x >= image.width) return;  // beyond the edges: rare
    for (const int row : {y, y + 1})
        if (row >= 0 && row < image.height) prefetch_texel(image, x, row);
}

Vec2 TextureSet::gradient(std::int32_t texture, const TexturePoint& at) const {
    const TextureKind& kind = textures_[static_cast<std::size_t>(texture)].kind;
    if (std::holds_alternative<MeshAttributeTexture>(kind))
        return gradient_over(slots_[static_cast<std::size_t>(texture)], at.on_mesh);
    const auto* bitmap = std::get_if<BitmapTexture>(&kind);
    if (!bitmap) return Vec2(0.0f);  // the others have steps, or count as flat
    const Vec2& uv = at.uv;
    const TextureImage& image = images_[static_cast<std::size_t>(bitmap->image)];
    // Half a texel, in the coordinates before the transform.
    const auto half_step = [&](float du, float dv) {
        const float texels =
            std::max(std::abs(du) * static_cast<float>(image.width), std::abs(dv) * static_cast<float>(image.height));
        return texels > 0.0f ? 0.5f / texels : 0.0f;
    };
    const float hu = half_step(bitmap->uv.u_row.x, bitmap->uv.v_row.x);
    const float hv = half_step(bitmap->uv.u_row.y, bitmap->uv.v_row.y);
    const auto difference = [&](const Vec2& step, float h) {
        return h > 0.0f ? (value(texture, uv + step) - value(texture, uv - step)) / (2.0f * h) : 0.0f;
    };
    return {difference({hu, 0.0f}, hu), difference({0.0f, hv}, hv)};
}

std::size_t TextureSet::memory() const {
    std::size_t bytes = 0;
    for (const TextureImage& image : images_)
        bytes += image.bytes.size() + image.floats.size() * sizeof(float);
    return bytes;
}

}  // namespace treefarm
