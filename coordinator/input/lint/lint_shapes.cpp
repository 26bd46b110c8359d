// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "coordinator/input/check/validation.h"
#include "coordinator/input/lint/lint.h"

namespace treefarm::linting {
namespace {

using enum Finding::Severity;

/// Number of triangles above which a mesh without normals is probably meant to be smooth.
constexpr std::size_t kFewTriangles = 64;

std::string count_of(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Corners of a triangle in sorted order: equal for coincident triangles.
using Corners = std::array<std::array<std::uint32_t, 3>, 3>;

struct HashCorners {
    std::size_t operator()(const Corners& corners) const {
        std::uint64_t hash = 0;
        for (const auto& corner : corners)
            for (const std::uint32_t bits : corner)
                hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
};

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh.positions[mesh.indices[3 * triangle + k]];
        // + 0: -0 and 0 are the same coordinate.
        corners[k] = {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
                      std::bit_cast<std::uint32_t>(p.z + 0.0f)};
    }
    std::sort(corners.begin(), corners.end());
    return corners;
}

class MeshLint {
  public:
    MeshLint(const Shape& shape, const Mesh& mesh, std::vector<Finding>& findings)
        : shape_(shape), mesh_(mesh), findings_(findings) {}

    /// Examines the mesh; false if its triangles are invalid.
    bool run() {
        if (mesh_.indices.size() % 3 != 0 ||
            std::any_of(mesh_.indices.begin(), mesh_.indices.end(),
                        [&](std::uint32_t i) { return i >= mesh_.positions.size(); })) {
            add(error, "bad indices", "has indices that are no whole triangles of its vertices", "repair the mesh");
            return false;
        }
        numbers();
        areas();
        normals();
        return true;
    }

  private:
    void add(Finding::Severity severity, const char* kind, const std::string& what, const std::string& cure) {
        findings_.push_back({severity, kind, shape_.where, named("shape", shape_.name) + " " + what, cure});
    }

    template <class Values, class Bad>
    void count_bad(const Values& values, Bad bad, const char* kind, const char* what) {
        const auto first = std::find_if(values.begin(), values.end(), bad);
        if (first == values.end()) return;
        const auto count = static_cast<std::size_t>(std::count_if(first, values.end(), bad));
        add(error, kind,
            "has " + count_of(count, what, (std::string(what) + "s").c_str()) + " that " + (count == 1 ? "is" : "are") +
                " not finite, the first is number " + std::to_string(first - values.begin() + 1),
            "repair the mesh");
    }

    void numbers() {
        const auto bad3 = [](const Vec3& v) { return !is_finite(v); };
        count_bad(mesh_.positions, bad3, "numbers", "vertex position");
        count_bad(mesh_.normals, bad3, "numbers", "normal");
        count_bad(
            mesh_.uvs, [](const Vec2& v) { return !std::isfinite(v.x) || !std::isfinite(v.y); }, "numbers",
            "texture coordinate");
    }

    void areas() {
        std::size_t degenerate = 0, slivers = 0, first = 0;
        for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
            const Imath::V3d a(mesh_.positions[mesh_.indices[3 * t]]), b(mesh_.positions[mesh_.indices[3 * t + 1]]),
                c(mesh_.positions[mesh_.indices[3 * t + 2]]);
            const Imath::V3d e1 = b - a, e2 = c - a, e3 = c - b;
            const double area = e1.cross(e2).length();
            const double longest = std::max({e1.dot(e1), e2.dot(e2), e3.dot(e3)});
            if (!(area > 1e-15 * longest)) {
                if (degenerate++ == 0) first = t;
            } else if (area < 1e-6 * longest) {
                ++slivers;
            }
        }
        if (degenerate > 0)
            add(warning, "degenerate triangles",
                "has " + count_of(degenerate, "triangle", "triangles") + " without area, the first is number " +
                    std::to_string(first + 1),
                "they are left out");
        if (slivers > 0)
            add(note, "slivers",
                "has " + count_of(slivers, "triangle", "triangles") + " thinner than a millionth of their length",
                "their normals are rounding errors");
    }

    void normals() {
        if (mesh_.normals.empty()) {
            if (mesh_.triangle_count() > kFewTriangles)
                add(note, "missing normals",
                    "has no normals: its " + std::to_string(mesh_.triangle_count()) + " triangles show as facets",
                    "export normals if it is meant to be smooth");
            return;
        }
        const auto zero =
            static_cast<std::size_t>(std::count_if(mesh_.normals.begin(), mesh_.normals.end(),
                                                   [](const Vec3& n) { return is_finite(n) && dot(n, n) < 1e-12f; }));
        if (zero > 0)
            add(warning, "missing normals", "has " + count_of(zero, "vertex", "vertices") + " whose normal is zero",
                "the triangles' own are used");
        std::size_t against = 0;
        for (std::size_t t = 0; t < mesh_.triangle_count() && mesh_.normals.size() == mesh_.positions.size(); ++t) {
            const std::uint32_t* corner = &mesh_.indices[3 * t];
            const Imath::V3d a(mesh_.positions[corner[0]]), b(mesh_.positions[corner[1]]),
                c(mesh_.positions[corner[2]]);
            const Imath::V3d face = (b - a).cross(c - a);
            int sides = 0;
            for (int k = 0; k < 3; ++k)
                sides += face.dot(Imath::V3d(mesh_.normals[corner[k]])) < 0 ? -1 : 1;
            against += std::abs(sides) == 1;  // corners disagree about the front
        }
        if (against > 0)
            add(note, "normals disagree",
                "has " + count_of(against, "triangle", "triangles") + " whose corners' normals lie on both sides",
                "repair the normals");
    }

    const Shape& shape_;
    const Mesh& mesh_;
    std::vector<Finding>& findings_;
};

/// Finds coincident triangles, of which a ray may hit either.
class Duplicates {
  public:
    explicit Duplicates(const Scene& scene) : scene_(scene) {}

    void look(std::size_t shape, const Mesh& mesh, std::vector<Finding>& findings) {
        std::size_t count = 0, other = shape;
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            const Corners corners = corners_of(mesh, t);
            if (corners[0] == corners[1] || corners[1] == corners[2]) continue;
            const auto [found, fresh] = seen_.try_emplace(corners, shape);
            if (fresh || scene_.shapes[found->second].group != scene_.shapes[shape].group) continue;
            if (count++ == 0) other = found->second;
        }
        if (count == 0) return;
        const Shape& of = scene_.shapes[shape];
        findings.push_back({warning, "duplicate triangles", of.where,
                            named("shape", of.name) + " has " + count_of(count, "triangle", "triangles") +
                                " that coincide" + (count == 1 ? "s" : "") + " with others" +
                                (other == shape ? " of its own" : " of " + named("shape", scene_.shapes[other].name)),
                            "remove one of them"});
    }

  private:
    const Scene& scene_;
    std::unordered_map<Corners, std::size_t, HashCorners> seen_;
};

}  // namespace

void lint_shapes(const Scene& scene, std::vector<Finding>& findings) {
    Duplicates duplicates(scene);
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        if (mesh && MeshLint(shape, *mesh, findings).run()) duplicates.look(i, *mesh, findings);
        if (validation::lacks_tangents(scene, shape))
            findings.push_back({warning, "anisotropy without uv", shape.where,
                                named("shape", shape.name) +
                                    " is anisotropic, but its mesh has no texture coordinates: highlights follow the "
                                    "edges of its triangles",
                                "export the mesh with texture coordinates"});
    }
}

}  // namespace treefarm::linting
