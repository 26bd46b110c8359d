#include "worker/geometry/embree_scene.h"

#include <embree3/rtcore.h>

#include <cmath>

#include "common/base/error.h"
#include "worker/geometry/sphere_geometry.h"

namespace treefarm {
namespace {

void note_error(void* user, RTCError code, const char* text) {
    std::string& message = *static_cast<std::string*>(user);
    if (message.empty()) message = "error " + std::to_string(static_cast<int>(code)) + ", " + (text ? text : "");
}

/// Embree takes what the processor has when it does not know, or does not find, the instruction set it is asked for.
/// Its roundings would then silently differ from other workers'.
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

float max_abs(const Vec3& v) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}

/// Unit normal of a triangle with these edges; a product of edges that leaves the range of float is redone in double.
Vec3 unit_normal(const Vec3& e1, const Vec3& e2) {
    const Vec3 n = cross(e1, e2);
    const float length2 = dot(n, n);
    if (length2 > 1e-30f && length2 < 1e30f) return n * (1.0f / std::sqrt(length2));
    const Imath::V3d a(e1), b(e2);
    const Imath::V3d wide = a.cross(b);
    const double length = std::sqrt(wide.dot(wide));
    if (!(length > 0)) return {0.0f, 0.0f, 1.0f};  // no area: no ray finds it
    return Vec3(wide / length);
}

RTCRay make_ray(const Ray& ray) {
    RTCRay r;
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.tnear = 0.0f;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.time = 0.0f;
    r.tfar = ray.length;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    return r;
}

RTCIntersectContext incoherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

}  // namespace

void EmbreeScene::ReleaseDevice::operator()(RTCDevice device) const {
    rtcReleaseDevice(device);
}

void EmbreeScene::ReleaseScene::operator()(RTCScene scene) const {
    rtcReleaseScene(scene);
}

EmbreeScene::EmbreeScene(std::vector<Shape> shapes, const std::string& isa)
    : shapes_(std::move(shapes)), surfaces_(shapes_.size()), error_(std::make_unique<std::string>()) {
    require_isa(isa);
    const std::string config = "threads=1,set_affinity=0,hugepages=0,isa=" + isa;
    device_.reset(rtcNewDevice(config.c_str()));
    if (!device_)
        throw RunError("Embree refused the device \"" + config + "\" (error " +
                       std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")");
    rtcSetDeviceErrorFunction(device_.get(), note_error, error_.get());
    scene_.reset(rtcNewScene(device_.get()));
    check_errors("making a scene");
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
    for (std::uint32_t i = 0; i < shape_count(); ++i) {
        if (auto* mesh = std::get_if<Mesh>(&shapes_[i].geometry))
            attach_mesh(i, *mesh);
        else
            attach_sphere(i, std::get<Sphere>(shapes_[i].geometry));
        check_errors("adding the shape \"" + shapes_[i].name + "\"");
    }
    rtcCommitScene(scene_.get());
    check_errors("building the hierarchy");
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::check_errors(const std::string& doing) const {
    if (!error_->empty()) throw RunError("Embree failed while " + doing + ": " + *error_);
}

void EmbreeScene::attach_mesh(std::uint32_t index, Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangle_count();
    for (const std::uint32_t i : mesh.indices)
        if (i >= vertices)
            throw RunError("the shape \"" + shapes_[index].name + "\" refers to vertex " + std::to_string(i) + " of " +
                           std::to_string(vertices));
    if (!mesh.normals.empty() && mesh.normals.size() != vertices)
        throw RunError("the shape \"" + shapes_[index].name + "\" has " + std::to_string(mesh.normals.size()) +
                       " normals for " + std::to_string(vertices) + " vertices");
    // Embree shares these arrays and reads 16 bytes from the start of each element: the last one needs room behind it.
    mesh.positions.emplace_back(0.0f);
    mesh.indices.push_back(0);
    surfaces_[index] = {mesh.positions.data(), mesh.normals.empty() ? nullptr : mesh.normals.data(),
                        mesh.indices.data(), static_cast<std::uint32_t>(triangles)};
    if (triangles == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(std::uint32_t), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, index);
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::attach_sphere(std::uint32_t index, const Sphere& sphere) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    set_sphere_callbacks(geometry, sphere);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, index);
    rtcReleaseGeometry(geometry);
}

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
    RTCIntersectContext context = incoherent_context();
    RTCRayHit query;
    query.ray = make_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    if (surfaces_[query.hit.geomID].positions)
        hit = triangle_point(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v);
    else
        hit = sphere_point(query.hit.geomID, {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
    return true;
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCIntersectContext context = incoherent_context();
    RTCRay query = make_ray(ray);
    rtcOccluded1(scene_.get(), &context, &query);
    return query.tfar < 0.0f;
}

Hit EmbreeScene::triangle_point(std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const {
    const Surface& surface = surfaces_[shape];
    const std::uint32_t* corner = surface.indices + 3 * std::size_t(primitive);
    const Vec3 &v0 = surface.positions[corner[0]], &v1 = surface.positions[corner[1]],
               &v2 = surface.positions[corner[2]];
    const Vec3 e1 = v1 - v0, e2 = v2 - v0;
    Hit hit;
    hit.shape = shape;
    hit.primitive = primitive;
    hit.b1 = b1;
    hit.b2 = b2;
    hit.p = v0 + (e1 * b1 + e2 * b2);
    hit.error = offset_bound(std::max(max_abs(v0), std::max(max_abs(v1), max_abs(v2))));
    hit.ng = unit_normal(e1, e2);
    hit.ns = hit.ng;
    if (surface.normals) {
        const Vec3 n = surface.normals[corner[0]] * (1.0f - b1 - b2) + surface.normals[corner[1]] * b1 +
                       surface.normals[corner[2]] * b2;
        const float length2 = dot(n, n);
        if (length2 > 1e-12f && length2 < 1e12f) {  // neither zero nor NaN
            hit.ns = n * (1.0f / std::sqrt(length2));
            if (dot(hit.ng, hit.ns) < 0.0f) hit.ng = -hit.ng;
        }
    }
    return hit;
}

Hit EmbreeScene::sphere_point(std::uint32_t shape, const Vec3& outward) const {
    const Sphere& s = std::get<Sphere>(shapes_[shape].geometry);
    Hit hit;
    hit.shape = shape;
    const Vec3 n = normalize(outward);
    hit.p = s.center + n * s.radius;
    hit.error = offset_bound(max_abs(s.center) + s.radius);
    hit.ng = s.flip_normals ? -n : n;
    hit.ns = hit.ng;
    return hit;
}

Vec2 EmbreeScene::uv(const Hit& hit) const {
    const auto* mesh = std::get_if<Mesh>(&shapes_[hit.shape].geometry);
    if (!mesh || mesh->uvs.empty()) return {hit.b1, hit.b2};
    const std::uint32_t* corner = mesh->indices.data() + 3 * std::size_t(hit.primitive);
    return mesh->uvs[corner[0]] * (1.0f - hit.b1 - hit.b2) + mesh->uvs[corner[1]] * hit.b1 +
           mesh->uvs[corner[2]] * hit.b2;
}

double EmbreeScene::triangle_area(std::uint32_t shape, std::uint32_t primitive) const {
    const Surface& surface = surfaces_[shape];
    const std::uint32_t* corner = surface.indices + 3 * std::size_t(primitive);
    const Imath::V3d v0(surface.positions[corner[0]]), v1(surface.positions[corner[1]]),
        v2(surface.positions[corner[2]]);
    const Imath::V3d n = (v1 - v0).cross(v2 - v0);
    return 0.5 * std::sqrt(n.dot(n));
}

}  // namespace treefarm
