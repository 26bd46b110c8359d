// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/embree_scene.h"
#include "worker/geometry/primitive_points.h"
#include "worker/geometry/user_geometry.h"

namespace treefarm {
namespace {

void note_error(void* user, RTCError code, const char* text) {
    std::string& message = *static_cast<std::string*>(user);
    if (message.empty()) message = "error " + std::to_string(static_cast<int>(code)) + ", " + (text ? text : "");
}

/// Throws RunError if the processor lacks the instruction set `isa`. Embree would silently take another one, whose
/// rounding differs from that of the other workers.
void require_isa(const std::string& isa) {
    const bool present = isa == "sse2"     ? __builtin_cpu_supports("sse2")
                         : isa == "sse4.2" ? __builtin_cpu_supports("sse4.2")
                         : isa == "avx"    ? __builtin_cpu_supports("avx")
                         : isa == "avx2"   ? __builtin_cpu_supports("avx2")
                         : isa == "avx512" ? __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
                                           : false;
    if (!present)
        throw RunError("this processor (or Embree) does not have the instruction set \"" + isa +
                       "\"; set farm.isa to one that all workers have: sse2, sse4.2, avx, avx2 or avx512");
}

}  // namespace

void EmbreeScene::ReleaseDevice::operator()(RTCDevice device) const {
    rtcReleaseDevice(device);
}

void EmbreeScene::ReleaseScene::operator()(RTCScene scene) const {
    rtcReleaseScene(scene);
}

EmbreeScene::EmbreeScene(std::vector<Shape> shapes, const std::string& isa, const ShapeMasks& masks, bool robust)
    : robust_(robust),
      hides_(!masks.hidden.empty()),
      shapes_(std::move(shapes)),
      surfaces_(shapes_.size()),
      error_(std::make_unique<std::string>()) {
    require_isa(isa);
    const LetFloatsBe embree;
    const std::string config = "threads=1,set_affinity=0,hugepages=0,isa=" + isa;
    device_.reset(rtcNewDevice(config.c_str()));
    if (!device_)
        throw RunError("Embree refused the device \"" + config + "\" (error " +
                       std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")");
    rtcSetDeviceErrorFunction(device_.get(), note_error, error_.get());
    make_masks(masks);
    if (robust_) find_extents();
    make_groups();
    scene_ = make_scene();
    for (std::uint32_t i = 0; i < shape_count(); ++i)
        if (shapes_[i].group == kNone) attach(scene_.get(), i, i);
    rtcCommitScene(scene_.get());
    check_errors("building the hierarchy");
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::check_errors(const std::string& doing) const {
    if (!error_->empty()) throw RunError("Embree failed while " + doing + ": " + *error_);
}

std::unique_ptr<RTCSceneTy, EmbreeScene::ReleaseScene> EmbreeScene::make_scene() const {
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene(rtcNewScene(device_.get()));
    check_errors("making a scene");
    rtcSetSceneFlags(scene.get(), robust_ ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

void EmbreeScene::make_masks(const ShapeMasks& masks) {
    if (masks.opacity.empty() && masks.hidden.empty()) return;
    for (const std::size_t size : {masks.opacity.size(), masks.hidden.size()})
        if (size != 0 && size != shapes_.size())
            throw RunError("there are masks for " + std::to_string(size) + " of " + std::to_string(shapes_.size()) +
                           " shapes");
    for (std::uint32_t i = 0; i < shape_count(); ++i) {
        const FloatInput opacity = masks.opacity.empty() ? FloatInput(1.0f) : masks.opacity[i];
        const Mask mask{i, &shapes_[i], opacity, masks.textures, !masks.hidden.empty() && masks.hidden[i]};
        if (opacity.varies() && !masks.textures) throw RunError("an opacity has a texture, but there are no textures");
        if (mask.lets_pass() || mask.hidden) masks_.push_back(mask);
    }
    if (!masks_.empty() && !rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
        throw RunError("this Embree was built without filter functions: it cannot render opacity masks");
}

void EmbreeScene::make_groups() {
    std::size_t count = 0;
    for (const Shape& shape : shapes_)
        if (shape.group != kNone) count = std::max(count, static_cast<std::size_t>(shape.group) + 1);
    constexpr std::size_t kMostEmptyGroups = 65536;
    groups_.resize(std::min(count, shapes_.size() + kMostEmptyGroups));
    for (std::uint32_t i = 0; i < shape_count(); ++i) {
        const Shape& shape = shapes_[i];
        if (shape.group == kNone) continue;
        if (shape.group < 0 || static_cast<std::size_t>(shape.group) >= groups_.size() ||
            std::holds_alternative<Instance>(shape.geometry))
            throw RunError("the shape \"" + shape.name + "\" cannot belong to group " + std::to_string(shape.group));
        Group& group = groups_[static_cast<std::size_t>(shape.group)];
        if (!group.scene) group.scene = make_scene();
        attach(group.scene.get(), static_cast<std::uint32_t>(group.members.size()), i);
        group.members.push_back(i);
    }
    for (const Group& group : groups_)
        if (group.scene) rtcCommitScene(group.scene.get());
    check_errors("building the groups");
}

void EmbreeScene::attach(RTCScene scene, std::uint32_t id, std::uint32_t index) {
    Shape& shape = shapes_[index];
    RTCGeometry geometry = nullptr;
    if (auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        geometry = mesh_geometry(index, *mesh);
    } else if (const auto* instance = std::get_if<Instance>(&shape.geometry)) {
        geometry = instance_geometry(index, *instance);
    } else {
        geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
        set_user_callbacks(geometry, shape, find_mask(index));
    }
    if (geometry) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
    check_errors("adding the shape \"" + shape.name + "\"");
}

/// Embree's geometry of a mesh; nullptr if it has no triangles.
RTCGeometry EmbreeScene::mesh_geometry(std::uint32_t index, Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangle_count();
    for (const std::uint32_t i : mesh.indices)
        if (i >= vertices)
            throw RunError("the shape \"" + shapes_[index].name + "\" refers to vertex " + std::to_string(i) + " of " +
                           std::to_string(vertices));
    if (!mesh.normals.empty() && mesh.normals.size() != vertices)
        throw RunError("the shape \"" + shapes_[index].name + "\" has " + std::to_string(mesh.normals.size()) +
                       " normals for " + std::to_string(vertices) + " vertices");
    if (!mesh.uvs.empty() && mesh.uvs.size() != vertices)
        throw RunError("the shape \"" + shapes_[index].name + "\" has " + std::to_string(mesh.uvs.size()) +
                       " texture coordinates for " + std::to_string(vertices) + " vertices");
    // Embree shares these arrays and reads 16 bytes from each element's start: the last one needs padding.
    mesh.positions.emplace_back(0.0f);
    mesh.indices.push_back(0);
    surfaces_[index] = {mesh.positions.data(), mesh.normals.empty() ? nullptr : mesh.normals.data(),
                        mesh.indices.data(), static_cast<std::uint32_t>(triangles)};
    if (triangles == 0) return nullptr;
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(std::uint32_t), triangles);
    if (const Mask* m = find_mask(index)) set_mask_filter(geometry, *m);
    return geometry;
}

/// Embree's geometry of an instance; nullptr if its group has no shapes.
RTCGeometry EmbreeScene::instance_geometry(std::uint32_t index, const Instance& instance) {
    if (instance.group < 0) throw RunError("the instance \"" + shapes_[index].name + "\" has no group");
    const auto group = static_cast<std::size_t>(instance.group);
    if (group >= groups_.size() || !groups_[group].scene) return nullptr;
    surfaces_[index].placement = static_cast<std::uint32_t>(placements_.size());
    placements_.emplace_back(instance, index);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, groups_[group].scene.get());
    // A matrix for row vectors has as rows what Embree calls columns.
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &instance.to_world[0][0]);
    return geometry;
}

const Mask* EmbreeScene::find_mask(std::uint32_t shape) const {
    const auto at = std::lower_bound(masks_.begin(), masks_.end(), shape,
                                     [](const Mask& m, std::uint32_t index) { return m.shape_index < index; });
    return at != masks_.end() && at->shape_index == shape ? &*at : nullptr;
}

}  // namespace treefarm
