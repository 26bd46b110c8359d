// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/area_measure.h"

#include "common/math/warp.h"

namespace treefarm {

std::vector<double> part_areas(const EmbreeScene& geometry, std::uint32_t shape) {
    const auto& kind = geometry.shape(shape).geometry;
    if (const auto* s = std::get_if<Sphere>(&kind)) return {4.0 * double(kPi) * double(s->radius) * double(s->radius)};
    if (const auto* d = std::get_if<Disk>(&kind)) {
        const Imath::V3d n = Imath::V3d(d->half_u).cross(Imath::V3d(d->half_v));
        return {double(kPi) * std::sqrt(n.dot(n))};
    }
    if (const auto* c = std::get_if<Cylinder>(&kind)) {
        const Imath::V3d axis = Imath::V3d(c->p1) - Imath::V3d(c->p0);
        return {2.0 * double(kPi) * double(c->radius) * std::sqrt(axis.dot(axis))};
    }
    std::vector<double> areas(geometry.triangle_count(shape));
    for (std::uint32_t i = 0; i < areas.size(); ++i)
        areas[i] = geometry.triangle_area(shape, i);
    return areas;
}

Hit uniform_point(const EmbreeScene& geometry, std::uint32_t shape, const Vec2& u) {
    const auto& kind = geometry.shape(shape).geometry;
    if (std::holds_alternative<Disk>(kind)) {
        const Vec2 d = square_to_disk(u);
        return geometry.disk_point(shape, d.x, d.y);
    }
    const auto& c = std::get<Cylinder>(kind);
    const SinCos turn = sincos_turn(u.y);
    const Vec3 side = cross(normalize(c.p1 - c.p0), c.meridian);
    return geometry.cylinder_point(shape, u.x, c.meridian * turn.cos + side * turn.sin);
}

namespace {

struct Means {
    const std::vector<TextureImage>& images;
    const Shape* shape;

    Rgb mean_of_image(std::int32_t index) const {
        const TextureImage& image = images[static_cast<std::size_t>(index)];
        Imath::V3d sum(0.0);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                sum += Imath::V3d(texel(image, x, y));
        return Rgb(Vec3(sum / (double(image.width) * double(image.height))));
    }
    Rgb mean_of_attribute(const std::string& name) const {
        const auto* mesh = shape ? std::get_if<Mesh>(&shape->geometry) : nullptr;
        const MeshAttribute* attribute = mesh ? mesh->find_attribute(name) : nullptr;
        if (!attribute || attribute->values.empty()) return Rgb(0.0f);
        Imath::V3d sum(0.0);
        for (const Rgb& value : attribute->values)
            sum += Imath::V3d(value);
        return Rgb(Vec3(sum / double(attribute->values.size())));
    }
};

}  // namespace

Rgb mean_color(const TextureSet& textures, std::int32_t texture, const Shape* shape) {
    return std::visit(
        [&]<class Kind>(const Kind& kind) {
            Rgb mean = kind.mean(Means{textures.images(), shape});
            // The white beyond the image may be its only visible part.
            if constexpr (requires { kind.has_beyond(Wrap::one); })
                if (kind.has_beyond(Wrap::one)) mean = mean * 0.5f + Rgb(0.5f);
            return mean;
        },
        textures.textures()[static_cast<std::size_t>(texture)].kind);
}

}  // namespace treefarm
