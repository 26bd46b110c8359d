// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm::test {

/// A valid scene with one of everything that a scene can contain, with different values wherever their order matters.
inline Scene every_kind_scene() {
    Scene scene;

    TextureImage bytes;
    bytes.width = 2, bytes.height = 1, bytes.channels = 3;
    bytes.bytes = {0, 64, 128, 192, 255, 1};
    for (std::size_t i = 0; i < 256; ++i)
        bytes.decode[i] = static_cast<float>(i) / 255.0f;
    bytes.name = "wood.png";
    TextureImage floats;
    floats.width = 1, floats.height = 2, floats.channels = 3;
    floats.floats = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 0.125f};
    floats.name = "sky.exr";
    TextureImage gray;
    gray.width = 1, gray.height = 1, gray.channels = 1;
    gray.floats = {0.5f};
    scene.images = {bytes, floats, gray};

    BitmapTexture bitmap;
    bitmap.image = 0, bitmap.bilinear = false, bitmap.wrap_u = Wrap::mirror, bitmap.wrap_v = Wrap::one;
    bitmap.uv = {Vec3(2, 0, 1), Vec3(0, 3, 4)};
    BitmapTexture plain;
    plain.image = 2;
    scene.camera.passes_hidden_emitters = true;
    scene.textures = {
        {bitmap, "wood", {"a.xml", 1, 2}},
        {CheckerboardTexture{Rgb(0.5f, 0.25f, 0.125f), Rgb(1.0f), {Vec3(4, 0, 0), Vec3(0, 5, 0)}}, "", {}},
        {plain, "gray", {}},
        {MeshAttributeTexture{"vertex_color"}, "painted", {"a.xml", 3, 4}},
        {MeshAttributeTexture{"face_wear"}, "worn", {}},
        {GridTexture{Rgb(0.25f), Rgb(0.75f), 0.125f, {Vec3(2, 0, 0), Vec3(0, 3, 0)}}, "grid", {}},
        {WireframeTexture{Rgb(0.125f), Rgb(0.5f), 0.25f, 0.75f}, "wires", {}}};

    const Roughness rough{Microfacets::ggx, {0.25f}, {0.5f, 2}}, coat{Microfacets::beckmann, {0.125f}, {0.125f}};
    const auto add = [&](decltype(Material::bsdf) bsdf) -> Material& {
        Material& material = scene.materials.emplace_back();
        material.bsdf = std::move(bsdf);
        material.name = "m" + std::to_string(scene.materials.size());
        material.where = {"a.xml", static_cast<int>(scene.materials.size()), 7};
        return material;
    };
    add(DiffuseMaterial{ColorInput(Rgb(0.1f, 0.2f, 0.3f), 0)}).unlimited = true;
    add(ConductorMaterial{Rgb(0.2f, 0.9f, 1.1f), Rgb(3.9f, 2.4f, 2.2f), Rgb(0.5f), rough}).twosided = true;
    add(DielectricMaterial{1.33f, Rgb(0.9f), ColorInput(Rgb(0.8f), 1), rough}).opacity = {0.5f, 2};
    add(ThinDielectricMaterial{1.25f, Rgb(0.7f), Rgb(0.6f)});
    add(PlasticMaterial{1.4f, ColorInput(Rgb(0.4f), 0), Rgb(0.3f), true, coat, true}).detail = {
        1, 0.25f, 0, Rgb(0.5f, 1.0f, 0.25f), true, true};
    add(BlendMaterial{{0.75f, 2}, 4, 0});
    add(NullMaterial{});
    Material& two = add(DiffuseMaterial{ColorInput(Rgb(0.5f), 3)});
    two.opacity = {0.75f, 4};
    two.twosided = true;
    two.back = 1;
    add(RoughDiffuseMaterial{ColorInput(Rgb(0.3f, 0.2f, 0.1f), 0), {0.75f, 2}, true});
    add(PhongMaterial{ColorInput(Rgb(0.25f), 0), Rgb(0.125f), {20.0f}});
    PrincipledMaterial principled{ColorInput(Rgb(0.5f, 0.25f, 0.125f), 0), {0.25f, 2}};
    principled.anisotropic = 0.5f, principled.metallic = {0.375f, 2}, principled.spec_trans = 0.625f;
    principled.spec_tint = 0.75f, principled.sheen = 0.125f, principled.sheen_tint = 0.25f;
    principled.flatness = {0.5f, 2}, principled.clearcoat = 0.875f, principled.clearcoat_gloss = 0.0625f;
    principled.eta = 1.375f;
    add(principled);
    add(CoatingMaterial{1.375f, ColorInput(Rgb(0.5f, 2.0f, 3.0f), 1), ColorInput(Rgb(0.75f), 0), coat, 0});
    PrincipledThinMaterial thin{ColorInput(Rgb(0.25f, 0.5f, 0.125f), 0), {0.375f, 2}};
    thin.anisotropic = 0.25f, thin.spec_trans = {0.5f, 2}, thin.spec_tint = 0.125f;
    thin.sheen = 0.375f, thin.sheen_tint = 0.625f, thin.flatness = 0.75f;
    thin.diff_trans = {0.5f, 2}, thin.eta = 1.25f;
    add(thin);
    add(DiffuseTransmitterMaterial{ColorInput(Rgb(0.25f, 0.5f, 0.75f), 0)});
    add(ThinLayerMaterial{ColorInput(Rgb(0.5f, 2.0f, 3.0f), 1), ColorInput(Rgb(0.75f), 0), {0.5f}, false});
    add(WardMaterial{Rgb(0.375f), Rgb(0.25f), WardVariant::duer, {Microfacets::beckmann, {0.25f}, {0.5f}}});

    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    mesh.normals = {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0)};
    mesh.uvs = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
    mesh.indices = {0, 1, 2};
    Mesh painted = mesh;
    painted.attributes = {{"vertex_color", {Rgb(0.5f, 0.25f, 0.125f), Rgb(0.75f), Rgb(0, 1, 0)}},
                          {"face_wear", {Rgb(0.375f)}}};
    Imath::M44f to_world(0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 3, 0, 5, 6, 7, 1);
    scene.shapes = {{mesh, 1, 0, kNone, "lamp", {"b.xml", 3, 4}},
                    {Sphere{Vec3(1, 2, 3), 4.0f, true, Vec3(0, 1, 0), Vec3(0, 0, 1), true}, 0, kNone, kNone, "", {}},
                    {Disk{Vec3(1, 1, 1), Vec3(2, 0, 0), Vec3(1, 3, 0), true}, 5, 1, kNone, "disk", {}},
                    {Cylinder{Vec3(0, 0, 1), Vec3(0, 0, 4), 2.0f, true, Vec3(0, 1, 0), true}, 2, kNone, kNone, "", {}},
                    {painted, 7, kNone, 0, "part", {"b.xml", 6, 2}},
                    {Instance{0, to_world}, kNone, kNone, kNone, "placed", {"b.xml", 9, 9}}};
    scene.group_count = 1;

    scene.emitters = {
        {AreaEmitter{ColorInput(Rgb(1, 2, 3), 1), 0}, {"b.xml", 5, 6}},
        {AreaEmitter{Rgb(4, 5, 6), 2}, {}},
        {PointEmitter{Vec3(1, 2, 3), Rgb(7, 8, 9)}, {}},
        {SpotEmitter{Vec3(3, 2, 1), Vec3(0, 1, 0), Rgb(1, 2, 4), 0.5f, 0.25f, 1, Vec3(0, 0, 1), Vec3(1, 0, 0)}, {}},
        {DirectionalEmitter{Vec3(1, 0, 0), Rgb(5, 4, 3)}, {}},
        {EnvironmentEmitter{1, 2.0f, Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), true}, {"b.xml", 7, 7}},
        {ProjectorEmitter{Vec3(4, 2, 1), Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(-1, 0, 0), 0.5f, 0.25f, {Rgb(3, 2, 1), 1}},
         {"b.xml", 8, 8}}};
    scene.camera = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9), Vec3(10, 11, 12), Vec3(13, 14, 15), Vec3(16, 17, 18)};
    scene.camera.parallel = Vec3(0, 0, 1);
    scene.camera.panoramic = true;
    scene.film = {200, 1, PixelFilter::gaussian, 2.0f, 0.5f, 0.25f, 0.75f, {7, 2, 65535, 9}};
    return scene;
}

}  // namespace treefarm::test
