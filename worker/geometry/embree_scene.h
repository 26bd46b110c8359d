// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

/// Opacity of the shapes that let some rays pass.
struct ShapeMasks {
    std::vector<FloatInput> opacity;       ///< per shape; empty: all are opaque
    std::vector<bool> hidden;              ///< per shape: camera rays pass it; empty: none
    const TextureSet* textures = nullptr;  ///< must outlive the scene; nullptr if no opacity is textured
};

/// Shapes of a scene with Embree's hierarchy over them; the only interface to Embree. Immutable after construction;
/// queries are thread-safe.
class EmbreeScene {
  public:
    /// Builds the hierarchy and takes the shapes over. `isa` as in Job::Farm: equal on every worker, since it decides
    /// rounding. Built by one thread, so that the hierarchy, and thus the choice among equally near hits, is the same
    /// everywhere. `robust`: no ray passes through an edge that two triangles share, and keep_inside() is active.
    /// Unused masks, instances and analytic shapes cost nothing. Throws RunError if Embree reports an error, the
    /// processor lacks the isa, or an index is out of range.
    EmbreeScene(std::vector<Shape> shapes, const std::string& isa, const ShapeMasks& masks = {}, bool robust = false);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// First hit of a ray, as Embree reports it.
    struct EmbreeHit {
        std::uint32_t instance, id, primitive;
        float u, v;
        Vec3 outward;
    };
    /// A ray, and pointers to its results: whether it hits anything, and the first hit.
    struct Query {
        const Ray* ray;
        EmbreeHit* embree_hit;
        bool* found;
    };
    /// Nearest surface along each ray. Rays go to Embree in packets, which saves calls, but as incoherent ones: each is
    /// traversed on its own, so that its hit does not depend on the other rays.
    void intersect(std::span<const Query> queries) const;
    /// Computes the surface point of a hit. Separate from intersect(), so that the memory latencies of many points
    /// overlap.
    void set_point(Hit& hit, const EmbreeHit& embree_hit) const;
    /// Prefetches the data that set_point() reads.
    void prefetch_point(const EmbreeHit& m) const {
        if (m.instance != kNoInstance) return;  // rare; read by other code
        const Surface& surface = surfaces_[m.id];
        const std::uint32_t* corner = surface.indices + 3 * std::size_t(m.primitive);
        for (int i = 0; i < 3; ++i) {
            prefetch_line(surface.positions + corner[i]);
            if (surface.normals) prefetch_line(surface.normals + corner[i]);
        }
    }
    /// Nearest surface along a ray, with its point: intersect() and set_point() in one.
    bool intersect(const Ray& ray, Hit& hit) const;
    /// Whether a surface occludes the segment or half line.
    bool occluded(const Ray& ray) const;
    /// Occlusion of up to kMostTogether rays, faster than one by one. A ray of negative length is unoccluded.
    static constexpr std::size_t kMostTogether = kDrawBatch;
    void occluded(std::span<const Ray> rays, bool* hidden) const;

    /// Moves a hit in a corner, if `robust`, so that rays from it start on the side of the walls from which `ray` came.
    /// Positions are rounded: close to an edge they, or their offsets, may be behind the other wall. Such a hit moves
    /// back along the ray until no primitive is that close: usually by a few hit.error, and up to the whole ray in a
    /// crease that is narrower than that. Other hits do not change. No guarantee for the far side of a transmitting
    /// surface.
    void keep_inside(Hit& hit, const Ray& ray) const {
        if (robust_) [[unlikely]]
            step_back(hit, ray);
    }

    /// Surface point of a triangle from barycentrics, equal to the one that intersect() reports for a ray through it.
    Hit triangle_point(std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const;
    /// As triangle_point(), but written into `hit`: a hit is too large to be copied for each ray.
    void set_triangle_point(Hit& hit, std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const;
    /// Triangles of a mesh; empty if it has shading normals.
    std::vector<FlatTriangle> flat_triangles(std::uint32_t shape) const;
    /// Surface point of a sphere in the direction `outward` (unit) from its centre.
    Hit sphere_point(std::uint32_t shape, const Vec3& outward) const;
    /// Surface points of disks and cylinders: see primitive_points.h.
    Hit disk_point(std::uint32_t shape, float a, float b) const;
    Hit cylinder_point(std::uint32_t shape, float along, const Vec3& outward) const;
    /// Texture coordinates of a hit; its barycentrics if the mesh has none.
    Vec2 uv(const Hit& hit) const;
    /// Position of a hit on its mesh; without a mesh for other shapes.
    MeshPoint mesh_point(const Hit& hit) const {
        return {std::get_if<Mesh>(&shapes_[hit.shape].geometry), hit.primitive, hit.b1, hit.b2};
    }
    /// Texture coordinates of a hit, with tangents in world space.
    SurfaceDetail detail(const Hit& hit) const;
    /// Opacity at a hit: probability that a ray meets the shape there, in [0, 1].
    float opacity(const Hit& hit) const;

    /// Sphere of a shape; nullptr for other kinds.
    const Sphere* sphere(std::uint32_t shape) const { return std::get_if<Sphere>(&shapes_[shape].geometry); }
    std::uint32_t triangle_count(std::uint32_t shape) const { return surfaces_[shape].triangle_count; }
    double triangle_area(std::uint32_t shape, std::uint32_t primitive) const;
    const Shape& shape(std::uint32_t index) const { return shapes_[index]; }
    /// Whether any shape has a mask.
    bool masked() const {
        return std::any_of(masks_.begin(), masks_.end(), [](const Mask& m) { return m.lets_pass(); });
    }
    /// Whether camera rays pass a shape.
    bool hidden(std::uint32_t shape) const {
        const Mask* const m = hides_ ? find_mask(shape) : nullptr;
        return m && m->hidden;
    }
    /// Mask of a shape; nullptr: every ray meets it.
    const Mask* mask(std::uint32_t shape) const {
        const Mask* const m = find_mask(shape);
        return m && m->lets_pass() ? m : nullptr;
    }
    std::uint32_t shape_count() const { return static_cast<std::uint32_t>(shapes_.size()); }

    /// Embree's handle, for benchmarks.
    RTCSceneTy* handle() const { return scene_.get(); }

  private:
    static constexpr std::uint32_t kNoInstance = ~0u;  ///< Embree's RTC_INVALID_GEOMETRY_ID
    static constexpr std::size_t kPacket = 8;

    /// Shape data that a hit needs, close together in memory.
    struct Surface {
        const Vec3* positions = nullptr;
        const Vec3* normals = nullptr;  ///< nullptr: none
        const std::uint32_t* indices = nullptr;
        std::uint32_t triangle_count = 0;
        std::uint32_t placement = 0;  ///< of an instance: index in placements_
    };
    struct ReleaseDevice {
        void operator()(RTCDeviceTy* device) const;
    };
    struct ReleaseScene {
        void operator()(RTCSceneTy* scene) const;
    };

    struct Surroundings;  ///< neighbourhood query of a point

    /// Shapes of an instanced group, numbered by their order in it.
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

    const bool robust_, hides_;
    std::vector<Shape> shapes_;
    std::vector<Surface> surfaces_;
    std::vector<Mask> masks_;  ///< of the masked shapes, in their order
    std::vector<Placement> placements_;
    std::vector<double> extents_;  ///< diagonals of shapes in their own spaces; filled if robust
    double largest_extent_ = 0;
    std::unique_ptr<std::string> error_;  ///< written by Embree's error callback
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::vector<Group> groups_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

}  // namespace treefarm
