#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/scene/scene.h"
#include "worker/geometry/hit.h"
#include "worker/geometry/ray.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace treefarm {

/// The shapes of a scene with Embree's hierarchy over them: the only place that sees Embree. Immutable after
/// construction; any number of threads may ask.
class EmbreeScene {
  public:
    /// Takes the shapes over. `isa` as in Job::Farm: the same on every worker, since it decides roundings. Built by one
    /// thread, so that the hierarchy, and with it the winner among equally near hits, is the same everywhere.
    /// Throws RunError when Embree reports an error, the processor lacks the isa, or an index is out of range.
    EmbreeScene(std::vector<Shape> shapes, const std::string& isa);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// The nearest surface along the ray; false if there is none. Tuned for incoherent rays (SPEED.md, section 1).
    bool intersect(const Ray& ray, Hit& hit) const;
    /// Whether anything lies on the segment or half line.
    bool occluded(const Ray& ray) const;

    /// A point of a triangle from its barycentrics: what intersect() reports for a ray through it.
    Hit triangle_point(std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const;
    /// The point of a sphere in the direction `outward` (unit) from its centre.
    Hit sphere_point(std::uint32_t shape, const Vec3& outward) const;
    /// Texture coordinates of a hit; the barycentrics where the mesh has none.
    Vec2 uv(const Hit& hit) const;

    /// nullptr if the shape is a mesh.
    const Sphere* sphere(std::uint32_t shape) const { return std::get_if<Sphere>(&shapes_[shape].geometry); }
    std::uint32_t triangle_count(std::uint32_t shape) const { return surfaces_[shape].triangle_count; }
    double triangle_area(std::uint32_t shape, std::uint32_t primitive) const;
    const Shape& shape(std::uint32_t index) const { return shapes_[index]; }
    std::uint32_t shape_count() const { return static_cast<std::uint32_t>(shapes_.size()); }

    /// Embree's handle, for benchmarks.
    RTCSceneTy* handle() const { return scene_.get(); }

  private:
    /// What a hit needs of a shape, side by side.
    struct Surface {
        const Vec3* positions = nullptr;
        const Vec3* normals = nullptr;  ///< nullptr: none
        const std::uint32_t* indices = nullptr;
        std::uint32_t triangle_count = 0;
    };
    struct ReleaseDevice {
        void operator()(RTCDeviceTy* device) const;
    };
    struct ReleaseScene {
        void operator()(RTCSceneTy* scene) const;
    };

    void attach_mesh(std::uint32_t index, Mesh& mesh);
    void attach_sphere(std::uint32_t index, const Sphere& sphere);
    void check_errors(const std::string& doing) const;

    std::vector<Shape> shapes_;
    std::vector<Surface> surfaces_;
    std::unique_ptr<std::string> error_;  ///< written by Embree's error callback
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

}  // namespace treefarm
