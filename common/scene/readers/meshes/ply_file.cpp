// SPDX-License-Identifier: Apache-2.0
#include "common/scene/readers/meshes/ply_file.h"

#include <array>

#include "common/scene/readers/input_file.h"
#include "common/scene/readers/meshes/ply_values.h"
#include "common/scene/readers/meshes/triangulate.h"

namespace treefarm {
namespace {

using namespace ply;

/// Roles of the vertices' properties, by their place.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, none };

/// A group of properties counts only if all of it is there.
std::vector<Role> roles_of(const Element& vertex) {
    std::vector<Role> roles(vertex.properties.size(), Role::none);
    const auto index_of = [&](std::string_view name) {
        const Property* property = vertex.find({name});
        return property && !property->is_list ? property - vertex.properties.data() : std::ptrdiff_t{-1};
    };
    const auto assign = [&](std::initializer_list<std::string_view> names, Role first) {
        for (const std::string_view name : names)
            if (index_of(name) < 0) return false;
        for (const std::string_view name : names) {
            roles[static_cast<std::size_t>(index_of(name))] = first;
            first = static_cast<Role>(static_cast<int>(first) + 1);
        }
        return true;
    };
    assign({"x", "y", "z"}, Role::x);
    assign({"nx", "ny", "nz"}, Role::nx);
    if (!assign({"u", "v"}, Role::u) && !assign({"texture_u", "texture_v"}, Role::u)) assign({"s", "t"}, Role::u);
    return roles;
}

template <class Values>
class BodyReader {
  public:
    BodyReader(Values values, const Header& header, const std::string& file)
        : values_(std::move(values)), header_(header), file_(file) {}

    Mesh read() {
        bool vertices = false, faces = false;
        for (const Element& element : header_.elements) {
            if (element.name == "vertex") {
                read_vertices(element);
                vertices = true;
            } else if (element.name == "face") {
                if (!vertices) refuse(element.line, "the faces stand before the vertices", "put the vertices first");
                read_faces(element);
                faces = true;
            } else {
                skip_elements(element);
            }
        }
        if (!vertices || !faces)
            refuse(1, std::string("the file has no element \"") + (vertices ? "face" : "vertex") + "\"",
                   "give a mesh of vertices and faces");
        values_.end();
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void refuse(int line, const std::string& what, const std::string& cure) const {
        throw InputError({file_, line, 1}, what, cure);
    }

    float finite(Type type) {
        const double value = values_.number(type);
        // Also false for what is no number.
        if (!(std::abs(value) <= double(std::numeric_limits<float>::max())))
            values_.refuse("a vertex has a value that is not finite in single precision", "repair the file");
        return static_cast<float>(value);
    }

    std::uint64_t list_length(const Property& list) {
        const std::int64_t length = values_.integer(list.count_type);
        if (length < 0 || static_cast<std::uint64_t>(length) > values_.most_values(list.type))
            values_.refuse("a list of " + std::to_string(length) + " values does not fit into the file",
                           "the file is cut short: repair it");
        return static_cast<std::uint64_t>(length);
    }

    void skip(const Property& property) {
        const std::uint64_t count = property.is_list ? list_length(property) : 1;
        for (std::uint64_t i = 0; i < count; ++i)
            values_.skip(property.type);
    }

    void skip_elements(const Element& element) {
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties)
                skip(property);
            values_.end_element();
        }
    }

    void read_vertices(const Element& element) {
        const std::vector<Role> roles = roles_of(element);
        const auto has = [&](Role role) { return std::find(roles.begin(), roles.end(), role) != roles.end(); };
        if (!has(Role::x)) refuse(element.line, "the vertices have no x, y and z", "give them positions");
        if (element.count >= std::uint64_t{1} << 31) refuse(element.line, "more than 2^31 vertices", "split the mesh");
        const auto count = static_cast<std::size_t>(element.count);
        mesh_.positions.reserve(count);
        if (has(Role::nx)) mesh_.normals.reserve(count);
        if (has(Role::u)) mesh_.uvs.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<float, 9> vertex{};
            for (std::size_t k = 0; k < roles.size(); ++k)
                if (roles[k] == Role::none)
                    skip(element.properties[k]);
                else
                    vertex[static_cast<std::size_t>(roles[k])] = finite(element.properties[k].type);
            values_.end_element();
            mesh_.positions.emplace_back(vertex[0], vertex[1], vertex[2]);
            if (has(Role::nx)) mesh_.normals.emplace_back(vertex[3], vertex[4], vertex[5]);
            if (has(Role::u)) mesh_.uvs.emplace_back(vertex[6], vertex[7]);
        }
    }

    void read_faces(const Element& element) {
        const Property* corners = element.find({"vertex_indices", "vertex_index"});
        if (!corners || !corners->is_list)
            refuse(corners ? corners->line : element.line, "the faces have no list vertex_indices",
                   "give them their vertices");
        if (!is_integer(corners->type))
            refuse(corners->line, "the vertices of faces are no integers", "use an integer type");
        mesh_.indices.reserve(static_cast<std::size_t>(std::min(element.count, values_.most_values(corners->type))) *
                              3);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties)
                if (&property == corners)
                    read_face(property);
                else
                    skip(property);
            values_.end_element();
        }
    }

    void read_face(const Property& list) {
        const std::uint64_t length = list_length(list);
        if (length < 3)
            values_.refuse("a face of " + std::to_string(length) + " corners", "a face needs at least three");
        face_.clear();
        for (std::uint64_t i = 0; i < length; ++i) {
            const std::int64_t index = values_.integer(list.type);
            if (index < 0 || static_cast<std::size_t>(index) >= mesh_.positions.size())
                values_.refuse("vertex " + std::to_string(index) + " of " + std::to_string(mesh_.positions.size()),
                               "vertices count from 0: repair the file");
            face_.push_back(static_cast<std::uint32_t>(index));
        }
        if (length == 3) {
            mesh_.indices.insert(mesh_.indices.end(), face_.begin(), face_.end());
            return;
        }
        polygon_.clear();
        for (const std::uint32_t index : face_)
            polygon_.push_back(mesh_.positions[index]);
        triangles_.clear();
        if (!triangulate(polygon_, triangles_))
            values_.refuse("a concave face of " + std::to_string(length) + " corners", "cut it into smaller ones");
        for (const std::array<std::size_t, 3>& triangle : triangles_)
            for (const std::size_t corner : triangle)
                mesh_.indices.push_back(face_[corner]);
    }

    Values values_;
    const Header& header_;
    const std::string& file_;
    Mesh mesh_;
    std::vector<std::uint32_t> face_;
    std::vector<Vec3> polygon_;
    std::vector<std::array<std::size_t, 3>> triangles_;
};

}  // namespace

Mesh parse_ply(std::string_view bytes, const std::string& file) {
    const Header header = parse_header(bytes, file);
    if (header.format == Format::ascii) return BodyReader(TextValues(bytes, header, file), header, file).read();
    return BodyReader(BinaryValues(bytes, header, file), header, file).read();
}

Mesh read_ply(const std::filesystem::path& path, const Location& asked_from) {
    return parse_ply(read_input_file(path, asked_from), path.string());
}

}  // namespace treefarm
