// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <unordered_map>

#include "common/base/hash.h"
#include "coordinator/input/meshes/obj_file.h"
#include "coordinator/input/mitsuba/mesh_files.h"
#include "coordinator/input/mitsuba/mesh_options.h"

namespace treefarm::mitsuba {
namespace {

template <class V>
struct BitHash {
    std::size_t operator()(const V& v) const {
        std::uint64_t hash = 0;
        // Adding zero gives -0 and 0, which are equal, the same bits.
        for (unsigned i = 0; i < V::dimensions(); ++i)
            hash = mix_bits(hash ^ std::bit_cast<std::uint32_t>(v[static_cast<int>(i)] + 0.0f));
        return hash;
    }
};

/// For each value the index of the first equal one.
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

/// Makes vertices of corners; equal corners share a vertex.
class CornerMerger {
  public:
    CornerMerger(const ObjFile& obj, bool with_normals, bool separate_groups)
        : obj_(obj),
          with_normals_(with_normals),
          separate_groups_(separate_groups),
          position_of_(first_equal(obj.positions)),
          uv_of_(first_equal(obj.uvs)) {}

    Mesh merge(const std::vector<ObjFile::Corner>& corners) const {
        std::unordered_map<ObjFile::Corner, std::uint32_t, CornerHash, CornerEqual> vertices;
        vertices.reserve(corners.size() / 4);
        bool any_uv = false, any_normal = false;
        Mesh mesh;
        mesh.indices.reserve(corners.size());
        for (const ObjFile::Corner& corner : corners) {
            constexpr std::uint32_t missing = ObjFile::Corner::kMissing;
            const ObjFile::Corner key = {position_of_[corner.position],
                                         corner.uv == missing ? missing : uv_of_[corner.uv],
                                         with_normals_ ? corner.normal : missing, separate_groups_ ? corner.group : 0};
            const auto [entry, is_new] = vertices.emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.indices.push_back(entry->second);
            if (!is_new) continue;
            mesh.positions.push_back(obj_.positions[key.position]);
            mesh.uvs.push_back(key.uv == missing ? Vec2(0.0f) : obj_.uvs[key.uv]);
            mesh.normals.push_back(key.normal == missing ? Vec3(0.0f) : obj_.normals[key.normal]);
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

  private:
    const ObjFile& obj_;
    bool with_normals_, separate_groups_;
    std::vector<std::uint32_t> position_of_, uv_of_;
};

/// Keeps only one group, by its number among those that have faces.
void select_group(ObjFile& obj, std::int64_t number, const Location& where) {
    std::int64_t at = -1;
    std::uint32_t group = 0;
    std::vector<ObjFile::Corner> kept;
    std::vector<std::int32_t> material_of;
    for (std::size_t i = 0; i < obj.corners.size(); ++i) {
        const ObjFile::Corner& corner = obj.corners[i];
        if (at < 0 || corner.group != group) ++at;
        group = corner.group;
        if (at != number) continue;
        kept.push_back(corner);
        if (i % 3 == 0) material_of.push_back(obj.material_of[i / 3]);
    }
    if (kept.empty())
        throw InputError(where, "group number " + std::to_string(number) + " of " + std::to_string(at + 1),
                         "give a shape index from 0");
    obj.corners = std::move(kept);
    obj.material_of = std::move(material_of);
}

bool same(const ObjMaterial& a, const ObjMaterial& b) {
    return a.material == b.material && a.emission == b.emission;
}

}  // namespace

std::vector<ObjPart> read_obj_parts(Properties& properties, MaterialReader& materials, bool on_emitter,
                                    Diagnostics& diagnostics) {
    const MeshOptions options = read_mesh_options(properties, true);
    const bool is_old = properties.element().version < 2;
    const bool separate_groups = is_old && !properties.boolean("collapse", false);
    const bool load_materials = properties.boolean("load_materials", is_old);
    const std::int64_t group = is_old ? properties.integer("shape_index", -1) : -1;

    ObjFile obj = read_obj(options.file, properties.where("filename"));
    if (obj.flat_faces > 0)
        diagnostics.warn(properties.where("filename"), std::to_string(obj.flat_faces) +
                                                           " faces of the OBJ file have fewer than three corners and "
                                                           "were left out");
    if (obj.corners.empty())
        throw InputError({options.file.string()}, "the OBJ file has no faces", "repair it, or remove the shape");
    if (group >= 0) select_group(obj, group, properties.where("shape_index"));
    const std::vector<ObjMaterial> assigned =
        assign_obj_materials(obj, options.file, load_materials, on_emitter, properties, materials, diagnostics);

    // Equal materials share a part, in order of their first use.
    std::vector<std::size_t> part_of(assigned.size(), assigned.size());
    std::vector<ObjPart> parts;
    std::vector<std::vector<ObjFile::Corner>> corners;
    for (std::size_t i = 0; i < obj.material_of.size(); ++i) {
        const auto material = static_cast<std::size_t>(obj.material_of[i] + 1);
        if (std::size_t& part = part_of[material]; part == assigned.size()) {
            part = 0;
            while (part < parts.size() && !same(parts[part].material, assigned[material]))
                ++part;
            if (part == parts.size()) {
                parts.push_back({{}, assigned[material]});
                corners.emplace_back();
            }
        }
        for (std::size_t corner = 3 * i; corner < 3 * i + 3; ++corner)
            corners[part_of[material]].push_back(obj.corners[corner]);
    }
    const CornerMerger merger(obj, !options.face_normals, separate_groups);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i].mesh = merger.merge(corners[i]);
        transform_mesh(parts[i].mesh, options, properties.where(), diagnostics);
    }
    return parts;
}

}  // namespace treefarm::mitsuba
