// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/prefetch.h"
#include "common/base/random_batch.h"
#include "common/scene/model/scene.h"
#include "worker/geometry/hit.h"
#include "worker/geometry/mask.h"
#include "worker/geometry/placement.h"
#include "worker/geometry/primitive_points.h"
#include "worker/geometry/ray.h"
#include "worker/geometry/surface_detail.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace treefarm {

/// Which shapes let some rays pass.
struct ShapeMasks {
    std::vector<FloatInput> opacity;       ///< per shape; empty: all are opaque
    const TextureSet* textures = nullptr;  ///< must outlive the scene; nullptr if no opacity varies
};

/// The shapes of a scene with Embree's hierarchy over them: the only place that sees Embree. Immutable after
/// construction; any number of threads may ask.
class EmbreeScene {
  public:
    /// Takes the shapes over. `isa` as in Job::Farm: the same on every worker, since it decides roundings. Built by one
    /// thread, so that the hierarchy, and with it the winner among equally near hits, is the same everywhere.
    /// `robust`: no ray slips through an edge that two triangles share, and keep_inside() does something.
    /// Masks, instances and analytic shapes cost nothing where there are none.
    /// Throws RunError when Embree reports an error, the processor lacks the isa, or an index is out of range.
    EmbreeScene(std::vector<Shape> shapes, const std::string& isa, const ShapeMasks& masks = {}, bool robust = false);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// The first hit of a ray, as Embree tells it.
    struct EmbreeHit {
        std::uint32_t instance, id, primitive;
        float u, v;
        Vec3 outward;
    };
    /// A ray, and where to put whether it meets anything, and what first.
    struct Query {
        const Ray* ray;
        EmbreeHit* embree_hit;
        bool* found;
    };
    /// The nearest surface along each ray. Rays go to Embree in packets, which spares calls, but as incoherent ones:
    /// each finds its own way through the hierarchy, so that what it hits does not depend on the others.
    void intersect(std::span<const Query> queries) const;
    /// The point that was met. Apart from intersect(), so that of many points none waits for another's memory.
    void set_point(Hit& hit, const EmbreeHit& embree_hit) const;
    /// Fetches what set_point() reads.
    void prefetch_point(const EmbreeHit& m) const {
        if (m.instance != kNoInstance) return;  // rare, and another's
        const Surface& surface = surfaces_[m.id];
        const std::uint32_t* corner = surface.indices + 3 * std::size_t(m.primitive);
        for (int i = 0; i < 3; ++i) {
            prefetch_line(surface.positions + corner[i]);
            if (surface.normals) prefetch_line(surface.normals + corner[i]);
        }
    }
    /// The nearest surface along a ray, and the point there: intersect() and set_point() in one.
    bool intersect(const Ray& ray, Hit& hit) const;
    /// Whether anything lies on the segment or half line.
    bool occluded(const Ray& ray) const;
    /// Whether anything lies on each of up to kMostTogether rays, faster than one by one. Negative lengths are free.
    static constexpr std::size_t kMostTogether = kDrawBatch;
    void occluded(std::span<const Ray> rays, bool* hidden) const;

    /// Moves a hit that is in a corner, if `robust`, so that what goes on from it starts on the side of the walls that
    /// `ray` came along. Positions are rounded: within their rounding of an edge they, or their offsets, may lie behind
    /// the other wall. Such a hit steps back along the ray until nothing is that near: farther than without by a few
    /// hit.error, and as far as the ray goes where a crease is narrower than that. Elsewhere hits stay what they are.
    /// For a side that the surface lets light pass to nothing is promised.
    void keep_inside(Hit& hit, const Ray& ray) const {
        if (robust_) [[unlikely]]
            step_back(hit, ray);
    }

    /// A point of a triangle from its barycentrics: what intersect() reports for a ray through it.
    Hit triangle_point(std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const;
    /// A triangle's point from its barycentrics, written into `hit`: a hit is too large to be copied for each ray.
    void set_triangle_point(Hit& hit, std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const;
    /// A mesh's triangles; none if it has shading normals.
    std::vector<FlatTriangle> flat_triangles(std::uint32_t shape) const;
    /// The point of a sphere in the direction `outward` (unit) from its centre.
    Hit sphere_point(std::uint32_t shape, const Vec3& outward) const;
    /// The points of disks and cylinders: see primitive_points.h.
    Hit disk_point(std::uint32_t shape, float a, float b) const;
    Hit cylinder_point(std::uint32_t shape, float along, const Vec3& outward) const;
    /// Texture coordinates of a hit; the barycentrics where the mesh has none.
    Vec2 uv(const Hit& hit) const;
    /// Where on its mesh it lies; no mesh for other shapes.
    MeshPoint mesh_point(const Hit& hit) const {
        return {std::get_if<Mesh>(&shapes_[hit.shape].geometry), hit.primitive, hit.b1, hit.b2};
    }
    /// Texture coordinates of a hit, with tangents in world space.
    SurfaceDetail detail(const Hit& hit) const;
    /// Probability that a ray meets the shape of the hit there, in [0, 1].
    float opacity(const Hit& hit) const;

    /// The sphere that a shape is; nullptr if it is another.
    const Sphere* sphere(std::uint32_t shape) const { return std::get_if<Sphere>(&shapes_[shape].geometry); }
    std::uint32_t triangle_count(std::uint32_t shape) const { return surfaces_[shape].triangle_count; }
    double triangle_area(std::uint32_t shape, std::uint32_t primitive) const;
    const Shape& shape(std::uint32_t index) const { return shapes_[index]; }
    /// Whether any shape lets rays pass.
    bool masked() const { return !masks_.empty(); }
    /// The mask of a shape; nullptr: every ray meets it.
    const Mask* mask(std::uint32_t shape) const { return find_mask(shape); }
    std::uint32_t shape_count() const { return static_cast<std::uint32_t>(shapes_.size()); }

    /// Embree's handle, for benchmarks.
    RTCSceneTy* handle() const { return scene_.get(); }

  private:
    static constexpr std::uint32_t kNoInstance = ~0u;  ///< Embree's RTC_INVALID_GEOMETRY_ID
    static constexpr std::size_t kPacket = 8;

    /// The parts of a shape that a hit needs, side by side.
    struct Surface {
        const Vec3* positions = nullptr;
        const Vec3* normals = nullptr;  ///< nullptr: none
        const std::uint32_t* indices = nullptr;
        std::uint32_t triangle_count = 0;
        std::uint32_t placement = 0;  ///< of an instance, in placements_
    };
    struct ReleaseDevice {
        void operator()(RTCDeviceTy* device) const;
    };
    struct ReleaseScene {
        void operator()(RTCSceneTy* scene) const;
    };

    struct Surroundings;  ///< of a point

    /// The shapes that instances of a group place, numbered by their order in it.
    struct Group {
        std::unique_ptr<RTCSceneTy, ReleaseScene> scene;
        std::vector<std::uint32_t> members;  ///< indices in Scene::shapes
    };

    void intersect_packet(std::span<const Query> queries) const;
    const Mask* find_mask(std::uint32_t shape) const;
    void make_masks(const ShapeMasks& masks);
    std::unique_ptr<RTCSceneTy, ReleaseScene> make_scene() const;
    void make_groups();
    void attach(RTCSceneTy* scene, std::uint32_t id, std::uint32_t shape);
    RTCGeometryTy* mesh_geometry(std::uint32_t shape, Mesh& mesh);
    RTCGeometryTy* instance_geometry(std::uint32_t shape, const Instance& instance);
    Hit other_point(std::uint32_t instance, std::uint32_t id, std::uint32_t primitive, float u, float v,
                    const Vec3& outward) const;
    Vec3 outward(const Hit& hit) const;
    void check_errors(const std::string& doing) const;
    void find_extents();
    void step_back(Hit& hit, const Ray& ray) const;
    double clearance(const Hit& hit) const;

    const bool robust_;
    std::vector<Shape> shapes_;
    std::vector<Surface> surfaces_;
    std::vector<Mask> masks_;  ///< of the masked shapes, in their order
    std::vector<Placement> placements_;
    std::vector<double> extents_;  ///< diagonals of shapes in their own spaces, if robust
    double largest_extent_ = 0;
    std::unique_ptr<std::string> error_;  ///< written by Embree's error callback
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::vector<Group> groups_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

}  // namespace treefarm
