#include "common/scene/mitsuba/obj_mesh.h"

#include <bit>
#include <filesystem>
#include <unordered_map>

#include "common/base/hash.h"
#include "common/scene/mesh_normals.h"
#include "common/scene/obj_file.h"

namespace treefarm::mitsuba {
namespace {

struct ObjOptions {
    bool face_normals = false;
    bool flip_normals = false;
    bool flip_tex_coords = true;
    bool separate_groups = false;  ///< normals are not smoothed across groups
};

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
Mesh merge_corners(const ObjFile& obj, const Matrix& to_world, const ObjOptions& options) {
    const std::vector<std::uint32_t> position_of = first_equal(obj.positions), uv_of = first_equal(obj.uvs);
    const NormalTransform normal_to_world(to_world);
    std::unordered_map<ObjFile::Corner, std::uint32_t, CornerHash, CornerEqual> vertices;
    vertices.reserve(obj.corners.size() / 4);
    bool any_uv = false, any_normal = false;
    Mesh mesh;
    mesh.indices.reserve(obj.corners.size());
    for (const ObjFile::Corner& corner : obj.corners) {
        constexpr std::uint32_t missing = ObjFile::Corner::kMissing;
        const ObjFile::Corner key = {position_of[corner.position], corner.uv == missing ? missing : uv_of[corner.uv],
                                     options.face_normals ? missing : corner.normal,
                                     options.separate_groups ? corner.group : 0};
        const auto [place, is_new] = vertices.emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.indices.push_back(place->second);
        if (!is_new) continue;
        mesh.positions.push_back(transform_point(to_world, obj.positions[key.position]));
        Vec2 uv = key.uv == missing ? Vec2(0.0f) : obj.uvs[key.uv];
        if (key.uv != missing && options.flip_tex_coords) uv.y = 1.0f - uv.y;
        mesh.uvs.push_back(uv);
        mesh.normals.push_back(key.normal == missing ? Vec3(0.0f) : normal_to_world(obj.normals[key.normal]));
        any_uv = any_uv || key.uv != missing;
        any_normal = any_normal || key.normal != missing;
    }
    if (!any_uv) mesh.uvs.clear();
    if (!any_normal) mesh.normals.clear();
    return mesh;
}

Mesh make_mesh(const ObjFile& obj, const Matrix& to_world, const ObjOptions& options, int version) {
    Mesh mesh = merge_corners(obj, to_world, options);
    const bool has_normals = !mesh.normals.empty();
    if (!has_normals && version >= 2 && is_mirroring(to_world)) flip_winding(mesh);
    if (options.face_normals) {
        if (options.flip_normals) flip_winding(mesh);
        return mesh;
    }
    compute_missing_normals(mesh);
    if (options.flip_normals)
        for (Vec3& normal : mesh.normals)
            normal = -normal;
    orient_by_normals(mesh);
    drop_redundant_normals(mesh);
    return mesh;
}

}  // namespace

Mesh read_obj_mesh(Properties& properties, Diagnostics& diagnostics) {
    if (!properties.has("filename"))
        throw InputError(properties.where(), properties.title() + " has no file name",
                         "add <string name=\"filename\" value=\"...\"/>");
    const std::filesystem::path scene_file = properties.where().file;
    const std::filesystem::path path = scene_file.parent_path() / properties.text("filename", "");
    const bool is_old = properties.element().version < 2;

    ObjOptions options;
    options.face_normals = properties.boolean("face_normals", false);
    options.flip_normals = properties.boolean("flip_normals", false);
    options.flip_tex_coords = properties.boolean("flip_tex_coords", true);
    options.separate_groups = is_old && !properties.boolean("collapse", false);
    const bool load_materials = properties.boolean("load_materials", is_old);
    for (const char* name : {"max_smooth_angle", "shape_index"})
        if (properties.has(name)) {
            diagnostics.unsupported(properties.where(name), std::string(name) + " is not available in this version",
                                    "prepare the file in a modelling program", "it is ignored");
            properties.ignore({name});
        }
    const Matrix to_world = properties.transform("to_world");

    const ObjFile obj = read_obj(path, properties.where("filename"));
    if (obj.corners.empty())
        throw InputError({path.string()}, "the OBJ file has no faces", "repair it, or remove the shape");
    if (obj.names_materials && load_materials && properties.children("bsdf").empty())
        diagnostics.warn(properties.where(), "the materials of " + path.string() + " are not read: the shape is grey");
    return make_mesh(obj, to_world, options, properties.element().version);
}

}  // namespace treefarm::mitsuba
