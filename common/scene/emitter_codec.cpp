// SPDX-License-Identifier: Apache-2.0
#include "common/scene/emitter_codec.h"

#include "common/scene/packed_values.h"

namespace treefarm::packed {
namespace {

/// The place of a kind of emitter in the variant is its number in packed form.
using Kind = decltype(Emitter::kind);
static_assert(std::is_same_v<std::variant_alternative_t<0, Kind>, AreaEmitter>);
static_assert(std::is_same_v<std::variant_alternative_t<1, Kind>, PointEmitter>);
static_assert(std::is_same_v<std::variant_alternative_t<2, Kind>, SpotEmitter>);
static_assert(std::is_same_v<std::variant_alternative_t<3, Kind>, DirectionalEmitter>);
static_assert(std::is_same_v<std::variant_alternative_t<4, Kind>, ConstantEmitter>);
static_assert(std::is_same_v<std::variant_alternative_t<5, Kind>, EnvironmentEmitter>);
static_assert(std::variant_size_v<Kind> == 6);

struct Put {
    ByteWriter& out;

    void operator()(const AreaEmitter& e) const {
        put_color(out, e.radiance);
        out.put(e.shape);
    }
    void operator()(const PointEmitter& e) const {
        put_vector(out, e.position);
        put_vector(out, e.intensity);
    }
    void operator()(const SpotEmitter& e) const {
        put_vector(out, e.position);
        put_vector(out, e.axis);
        put_vector(out, e.intensity);
        out.put(e.cutoff);
        out.put(e.beam);
        out.put(e.texture);
        put_vector(out, e.x_axis);
        put_vector(out, e.y_axis);
    }
    void operator()(const DirectionalEmitter& e) const {
        put_vector(out, e.direction);
        put_vector(out, e.irradiance);
    }
    void operator()(const ConstantEmitter& e) const { put_vector(out, e.radiance); }
    void operator()(const EnvironmentEmitter& e) const {
        out.put(e.image);
        out.put(e.scale);
        put_vector(out, e.x_axis);
        put_vector(out, e.y_axis);
        put_vector(out, e.z_axis);
        put_flag(out, e.rows_at_poles);
    }
};

SpotEmitter get_spot(ByteReader& in, std::size_t texture_count) {
    SpotEmitter e;
    e.position = get_vector<Vec3>(in);
    e.axis = get_vector<Vec3>(in);
    e.intensity = get_vector<Rgb>(in);
    e.cutoff = in.get<float>();
    e.beam = in.get<float>();
    e.texture = get_optional_index(in, texture_count, "texture of a spot");
    e.x_axis = get_vector<Vec3>(in);
    e.y_axis = get_vector<Vec3>(in);
    return e;
}

EnvironmentEmitter get_environment(ByteReader& in, std::size_t image_count) {
    EnvironmentEmitter e;
    e.image = get_index(in, image_count, "image");
    e.scale = in.get<float>();
    e.x_axis = get_vector<Vec3>(in);
    e.y_axis = get_vector<Vec3>(in);
    e.z_axis = get_vector<Vec3>(in);
    e.rows_at_poles = get_flag(in, "rows_at_poles");
    return e;
}

}  // namespace

void put_emitter(ByteWriter& out, const Emitter& emitter) {
    out.put(static_cast<std::uint8_t>(emitter.kind.index()));
    std::visit(Put{out}, emitter.kind);
    put_location(out, emitter.where);
}

Emitter get_emitter(ByteReader& in, std::size_t shape_count, std::size_t texture_count, std::size_t image_count) {
    Emitter emitter;
    switch (const auto kind = in.get<std::uint8_t>()) {
        case 0: {
            AreaEmitter area;
            area.radiance = get_color(in, texture_count);
            area.shape = get_index(in, shape_count, "emitting shape");
            emitter.kind = area;
            break;
        }
        case 1: {
            PointEmitter point;
            point.position = get_vector<Vec3>(in);
            point.intensity = get_vector<Rgb>(in);
            emitter.kind = point;
            break;
        }
        case 2:
            emitter.kind = get_spot(in, texture_count);
            break;
        case 3: {
            DirectionalEmitter directional;
            directional.direction = get_vector<Vec3>(in);
            directional.irradiance = get_vector<Rgb>(in);
            emitter.kind = directional;
            break;
        }
        case 4:
            emitter.kind = ConstantEmitter{get_vector<Rgb>(in)};
            break;
        case 5:
            emitter.kind = get_environment(in, image_count);
            break;
        default:
            throw FormatError("scene: unknown kind of emitter " + std::to_string(kind));
    }
    emitter.where = get_location(in);
    return emitter;
}

}  // namespace treefarm::packed
