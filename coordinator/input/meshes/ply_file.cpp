// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/ply_file.h"

#include <array>

#include "common/image/srgb.h"
#include "coordinator/input/meshes/input_file.h"
#include "coordinator/input/meshes/ply_attributes.h"
#include "coordinator/input/meshes/ply_values.h"
#include "coordinator/input/meshes/triangulate.h"

namespace treefarm {
namespace {

using namespace ply;

/// Meaning of a vertex property.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, none };

/// Largest value of an integer type.
double largest_of(Type type) {
    const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
    return std::ldexp(1.0, 8 * static_cast<int>(size_of(type)) - (is_signed ? 1 : 0)) - 1.0;
}

/// Meaning of each property; a group of properties counts only if it is complete.
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

/// Collects the attributes of an element in a mesh.
class AttributeReader {
  public:
    AttributeReader(const Element& element, Mesh& mesh)
        : groups_(attribute_groups(element)),
          wanted_(element.properties.size(), false),
          row_(element.properties.size(), 0.0f),
          mesh_(mesh),
          first_(mesh.attributes.size()) {
        for (const AttributeGroup& group : groups_) {
            mesh.add_attribute(group.name);
            for (const std::size_t property : group.properties)
                wanted_[property] = true;
        }
    }
    bool wants(std::size_t property) const { return wanted_[property]; }
    void set(std::size_t property, float value) { row_[property] = value; }
    /// Extends each attribute to `count` values with the current ones.
    void fill(std::size_t count) {
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            const std::vector<std::size_t>& from = groups_[i].properties;
            const Rgb value = from.size() == 1 ? Rgb(row_[from[0]]) : Rgb(row_[from[0]], row_[from[1]], row_[from[2]]);
            mesh_.attributes[first_ + i].values.resize(count, value);
        }
    }

  private:
    std::vector<AttributeGroup> groups_;
    std::vector<bool> wanted_;
    std::vector<float> row_;
    Mesh& mesh_;
    std::size_t first_;
};

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
        // also false for NaN
        if (!(std::abs(value) <= double(std::numeric_limits<float>::max())))
            values_.refuse("a vertex has a value that is not finite in single precision", "repair the file");
        return static_cast<float>(value);
    }

    /// Value of an attribute: as in Mitsuba 2 and 3, integers are sRGB with their maximum as 1. Whether it is finite is
    /// checked only for attributes that textures need.
    float channel(Type type) {
        const double value = values_.any_number(type);
        if (!is_integer(type)) return static_cast<float>(value);
        return srgb_decode(static_cast<float>(value / largest_of(type)));
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
        AttributeReader attributes(element, mesh_);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<float, static_cast<std::size_t>(Role::none)> vertex{};
            for (std::size_t k = 0; k < roles.size(); ++k)
                if (roles[k] != Role::none)
                    vertex[static_cast<std::size_t>(roles[k])] = finite(element.properties[k].type);
                else if (attributes.wants(k))
                    attributes.set(k, channel(element.properties[k].type));
                else
                    skip(element.properties[k]);
            values_.end_element();
            mesh_.positions.emplace_back(vertex[0], vertex[1], vertex[2]);
            if (has(Role::nx)) mesh_.normals.emplace_back(vertex[3], vertex[4], vertex[5]);
            if (has(Role::u)) mesh_.uvs.emplace_back(vertex[6], vertex[7]);
            attributes.fill(mesh_.positions.size());
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
        AttributeReader attributes(element, mesh_);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < element.properties.size(); ++k)
                if (const Property& property = element.properties[k]; &property == corners)
                    read_face(property);
                else if (attributes.wants(k))
                    attributes.set(k, channel(property.type));
                else
                    skip(property);
            attributes.fill(mesh_.triangle_count());  // all triangles of a polygon have its value
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
