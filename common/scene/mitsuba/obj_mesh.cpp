#include <bit>
#include <unordered_map>

#include "common/base/hash.h"
#include "common/scene/mitsuba/mesh_files.h"
#include "common/scene/mitsuba/mesh_options.h"
#include "common/scene/obj_file.h"

namespace treefarm::mitsuba {
namespace {

template <class V>
struct BitHash {
    std::size_t operator()(const V& v) const {
        std::uint64_t hash = 0;
        // Adding zero makes -0 and 0, which are equal, the same bits.
        for (unsigned i = 0; i < V::dimensions(); ++i)
            hash = mix_bits(hash ^ std::bit_cast<std::uint32_t>(v[static_cast<int>(i)] + 0.0f));
        return hash;
    }
};

/// For each value the index of the first one that is equal.
template <class V>
std::vector<std::uint32_t> first_equal(const std::vector<V>& values) {
    std::unordered_map<V, std::uint32_t, BitHash<V>> first;
    first.reserve(values.size());
    std::vector<std::uint32_t> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        result[i] = first.emplace(values[i], static_cast<std::uint32_t>(i)).first->second;
    return result;
}

struct CornerHash {
    std::size_t operator()(const ObjFile::Corner& c) const {
        const std::uint64_t low = c.position | std::uint64_t{c.uv} << 32;
        const std::uint64_t high = c.normal | std::uint64_t{c.group} << 32;
        return mix_bits(mix_bits(low) ^ high);
    }
};

struct CornerEqual {
    bool operator()(const ObjFile::Corner& a, const ObjFile::Corner& b) const {
        return a.position == b.position && a.uv == b.uv && a.normal == b.normal && a.group == b.group;
    }
};

/// Corners that agree in everything become one vertex.
Mesh merge_corners(const ObjFile& obj, bool with_normals, bool separate_groups) {
    const std::vector<std::uint32_t> position_of = first_equal(obj.positions), uv_of = first_equal(obj.uvs);
    std::unordered_map<ObjFile::Corner, std::uint32_t, CornerHash, CornerEqual> vertices;
    vertices.reserve(obj.corners.size() / 4);
    bool any_uv = false, any_normal = false;
    Mesh mesh;
    mesh.indices.reserve(obj.corners.size());
    for (const ObjFile::Corner& corner : obj.corners) {
        constexpr std::uint32_t missing = ObjFile::Corner::kMissing;
        const ObjFile::Corner key = {position_of[corner.position], corner.uv == missing ? missing : uv_of[corner.uv],
                                     with_normals ? corner.normal : missing, separate_groups ? corner.group : 0};
        const auto [place, is_new] = vertices.emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.indices.push_back(place->second);
        if (!is_new) continue;
        mesh.positions.push_back(obj.positions[key.position]);
        mesh.uvs.push_back(key.uv == missing ? Vec2(0.0f) : obj.uvs[key.uv]);
        mesh.normals.push_back(key.normal == missing ? Vec3(0.0f) : obj.normals[key.normal]);
        any_uv = any_uv || key.uv != missing;
        any_normal = any_normal || key.normal != missing;
    }
    if (!any_uv) mesh.uvs.clear();
    if (!any_normal) mesh.normals.clear();
    mesh.positions.shrink_to_fit();
    mesh.uvs.shrink_to_fit();
    mesh.normals.shrink_to_fit();
    return mesh;
}

/// Leaves only the group of that number among those that have faces.
void select_group(ObjFile& obj, std::int64_t number, const Location& where) {
    std::int64_t at = -1;
    std::uint32_t group = 0;
    std::vector<ObjFile::Corner> kept;
    for (const ObjFile::Corner& corner : obj.corners) {
        if (at < 0 || corner.group != group) ++at;
        group = corner.group;
        if (at == number) kept.push_back(corner);
    }
    if (kept.empty())
        throw InputError(where, "group number " + std::to_string(number) + " of " + std::to_string(at + 1),
                         "give a shape index from 0");
    obj.corners = std::move(kept);
}

}  // namespace

Mesh read_obj_mesh(Properties& properties, Diagnostics& diagnostics) {
    const MeshOptions options = read_mesh_options(properties, true);
    const bool is_old = properties.element().version < 2;
    const bool separate_groups = is_old && !properties.boolean("collapse", false);
    const bool load_materials = properties.boolean("load_materials", is_old);
    const std::int64_t group = is_old ? properties.integer("shape_index", -1) : -1;

    ObjFile obj = read_obj(options.file, properties.where("filename"));
    if (obj.corners.empty())
        throw InputError({options.file.string()}, "the OBJ file has no faces", "repair it, or remove the shape");
    if (obj.names_materials && load_materials && properties.children("bsdf").empty())
        diagnostics.warn(properties.where(),
                         "the materials of " + options.file.string() + " are not read: the shape is grey");
    if (group >= 0) select_group(obj, group, properties.where("shape_index"));
    Mesh mesh = merge_corners(obj, !options.face_normals, separate_groups);
    place_mesh(mesh, options, properties.where(), diagnostics);
    return mesh;
}

}  // namespace treefarm::mitsuba
