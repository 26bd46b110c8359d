// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/mesh_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace treefarm {
namespace {

using Vec3d = Imath::V3d;

/// Normal of a triangle; zero if it has no area.
Vec3d triangle_normal(const Mesh& mesh, std::size_t triangle) {
    const Vec3d a(mesh.positions[mesh.indices[3 * triangle]]);
    const Vec3d b(mesh.positions[mesh.indices[3 * triangle + 1]]);
    const Vec3d c(mesh.positions[mesh.indices[3 * triangle + 2]]);
    return (b - a).cross(c - a).normalized();
}

}  // namespace

void compute_missing_normals(Mesh& mesh) {
    mesh.normals.resize(mesh.positions.size(), Vec3(0.0f));
    std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0.0));
    std::vector<Vec3d> any(mesh.positions.size(), Vec3d(0.0));
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Vec3d normal = triangle_normal(mesh, i);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.indices[3 * i + k];
            const Vec3d corner(mesh.positions[vertex]);
            const Vec3d to_next = Vec3d(mesh.positions[mesh.indices[3 * i + (k + 1) % 3]]) - corner;
            const Vec3d to_last = Vec3d(mesh.positions[mesh.indices[3 * i + (k + 2) % 3]]) - corner;
            sums[vertex] += normal * std::atan2(to_next.cross(to_last).length(), to_next.dot(to_last));
            if (normal != Vec3d(0.0)) any[vertex] = normal;
        }
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        if (mesh.normals[i] != Vec3(0.0f)) continue;
        // Normals that cancel (two triangles back to back) have no mean; any of them is used.
        const Vec3d normal = sums[i].length() > 1e-6 ? sums[i].normalized() : any[i];
        mesh.normals[i] = normal == Vec3d(0.0) ? Vec3(0.0f, 0.0f, 1.0f) : Vec3(normal);
    }
}

void flip_winding(Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
        std::swap(mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]);
}

void orient_by_normals(Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        Vec3d sum(0.0);
        for (std::size_t k = 0; k < 3; ++k)
            sum += Vec3d(mesh.normals[mesh.indices[3 * i + k]]);
        if (sum.dot(triangle_normal(mesh, i)) < 0.0) std::swap(mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]);
    }
}

void split_at_edges(Mesh& mesh, double min_cosine) {
    const bool has_uvs = !mesh.uvs.empty();
    const auto key = [&](std::uint32_t corner) {
        const std::uint32_t vertex = mesh.indices[corner];
        const Vec3& p = mesh.positions[vertex];
        const Vec2 uv = has_uvs ? mesh.uvs[vertex] : Vec2(0.0f);
        return std::array<float, 5>{p.x, p.y, p.z, uv.x, uv.y};
    };
    std::vector<std::uint32_t> corners(mesh.indices.size());
    std::iota(corners.begin(), corners.end(), 0u);
    std::stable_sort(corners.begin(), corners.end(), [&](auto a, auto b) { return key(a) < key(b); });
    std::vector<Vec3d> normals(mesh.triangle_count());
    for (std::size_t i = 0; i < normals.size(); ++i)
        normals[i] = triangle_normal(mesh, i);

    Mesh split;
    std::vector<std::uint32_t> origins;  // per new vertex, the one it comes from
    split.indices.resize(mesh.indices.size());
    for (std::size_t begin = 0, end; begin < corners.size(); begin = end) {
        for (end = begin + 1; end < corners.size() && key(corners[end]) == key(corners[begin]);)
            ++end;
        // Normals of the clusters at this position, and their vertices: few, since few triangles meet in a point.
        std::vector<std::pair<Vec3d, std::uint32_t>> clusters;
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d& normal = normals[corners[i] / 3];
            const auto fits = [&](const auto& cluster) {
                return cluster.first == normal || cluster.first.dot(normal) > min_cosine;
            };
            auto cluster = std::find_if(clusters.begin(), clusters.end(), fits);
            if (cluster == clusters.end()) {
                clusters.emplace_back(normal, static_cast<std::uint32_t>(split.positions.size()));
                cluster = clusters.end() - 1;
                split.positions.push_back(mesh.positions[mesh.indices[corners[i]]]);
                if (has_uvs) split.uvs.push_back(mesh.uvs[mesh.indices[corners[i]]]);
                origins.push_back(mesh.indices[corners[i]]);
            }
            split.indices[corners[i]] = cluster->second;
        }
    }
    for (MeshAttribute& attribute : mesh.attributes) {
        MeshAttribute& copy = split.add_attribute(attribute.name);
        if (attribute.is_of_faces())
            copy.values = std::move(attribute.values);
        else
            for (const std::uint32_t origin : origins)
                copy.values.push_back(attribute.values[origin]);
    }
    mesh = std::move(split);
}

void drop_redundant_normals(Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Vec3d normal = triangle_normal(mesh, i);
        if (normal == Vec3d(0.0)) continue;
        for (std::size_t k = 0; k < 3; ++k)
            if (!Vec3d(mesh.normals[mesh.indices[3 * i + k]]).equalWithAbsError(normal, 1e-5)) return;
    }
    mesh.normals.clear();
}

}  // namespace treefarm
