// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/obj_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "common/base/text/parse_text.h"
#include "coordinator/input/meshes/input_file.h"
#include "coordinator/input/meshes/obj_scanner.h"
#include "coordinator/input/meshes/triangulate.h"

namespace treefarm {
namespace {

/// Largest index into a list, checked at the end, since positive indices may refer to later lines.
struct LargestIndex {
    std::uint64_t index = 0;
    Location where;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& file) : scanner_(text, file) {}

    ObjFile read() {
        std::string_view keyword;
        while (scanner_.next_statement(keyword)) {
            if (keyword == "v")
                read_position();
            else if (keyword == "vn")
                obj_.normals.push_back(read_vector());
            else if (keyword == "vt")
                read_uv();
            else if (keyword == "f")
                read_face();
            else if (keyword == "g")
                ++group_;
            else if (keyword == "usemtl")
                use_material();
            else if (keyword == "mtllib")
                obj_.libraries.push_back(scanner_.rest());
            else if (!is_ignored(keyword))
                throw InputError(scanner_.where(), in_quotes(keyword) + " is no statement of an OBJ file",
                                 "repair the file, or check that it is an OBJ file");
        }
        check(largest_position_, obj_.positions.size(), "vertex");
        check(largest_uv_, obj_.uvs.size(), "texture coordinate");
        check(largest_normal_, obj_.normals.size(), "normal");
        return std::move(obj_);
    }

  private:
    static bool is_ignored(std::string_view keyword) {
        constexpr std::array<std::string_view, 31> known = {
            "o",        "s",    "l",      "p",      "vp",         "mg",        "bevel", "c_interp",
            "d_interp", "lod",  "usemap", "maplib", "shadow_obj", "trace_obj", "ctech", "stech",
            "deg",      "bmat", "step",   "cstype", "curv",       "curv2",     "surf",  "parm",
            "trim",     "hole", "scrv",   "sp",     "end",        "con",       "call"};
        return std::find(known.begin(), known.end(), keyword) != known.end();
    }

    static void check(const LargestIndex& largest, std::size_t count, const char* what) {
        if (largest.index > count)
            throw InputError(largest.where,
                             std::string(what) + " " + std::to_string(largest.index) + " of " + std::to_string(count),
                             "the file is cut short or has a wrong index: repair it");
    }

    float number(std::string_view word) const {
        const auto value = parse_number(word);
        if (!value || std::abs(*value) > std::numeric_limits<float>::max())
            throw InputError(scanner_.where(), in_quotes(word) + " is not a number", "write a finite decimal number");
        return static_cast<float>(*value);
    }

    float next_number() {
        std::string_view word;
        if (!scanner_.next_word(word))
            throw InputError(scanner_.where(), "a coordinate is missing here", "the file is cut short: repair it");
        return number(word);
    }

    Vec3 read_vector() {
        Vec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = next_number();
        return v;
    }

    void read_position() {
        obj_.positions.push_back(read_vector());
        if (obj_.positions.size() >= std::numeric_limits<std::int32_t>::max())
            throw InputError(scanner_.where(), "more than 2^31 vertices", "split the mesh");
    }

    void read_uv() {
        Vec2 uv(next_number(), 0.0f);
        std::string_view word;
        if (scanner_.next_word(word)) uv.y = number(word);
        obj_.uvs.push_back(uv);
    }

    /// Index from 0 on, for "7" (the seventh) or "-1" (the last so far).
    std::uint32_t index(std::string_view text, std::size_t count, LargestIndex& largest) {
        const auto value = parse_integer(text);
        if (!value || *value == 0 || *value > std::numeric_limits<std::int32_t>::max())
            throw InputError(scanner_.where(), in_quotes(text) + " is not an index",
                             "indices count from 1, or from -1 backwards");
        if (*value < 0) {
            const std::int64_t from_start = static_cast<std::int64_t>(count) + *value;
            if (*value < -static_cast<std::int64_t>(count))
                throw InputError(scanner_.where(), "index " + std::to_string(*value) + " of " + std::to_string(count),
                                 "it points before the first one: repair the file");
            return static_cast<std::uint32_t>(from_start);
        }
        const auto one_based = static_cast<std::uint64_t>(*value);
        if (one_based > count && one_based > largest.index) largest = {one_based, scanner_.where()};
        return static_cast<std::uint32_t>(one_based - 1);
    }

    /// Corner from "v", "v/t", "v//n" or "v/t/n".
    ObjFile::Corner corner(std::string_view word) {
        ObjFile::Corner result;
        result.group = group_;
        const std::size_t first = word.find('/');
        result.position = index(word.substr(0, first), obj_.positions.size(), largest_position_);
        if (first == std::string_view::npos) return result;
        const std::string_view rest = word.substr(first + 1);
        const std::size_t second = rest.find('/');
        const std::string_view uv = rest.substr(0, second);
        const std::string_view normal = second == std::string_view::npos ? "" : rest.substr(second + 1);
        if (!uv.empty()) result.uv = index(uv, obj_.uvs.size(), largest_uv_);
        if (!normal.empty()) result.normal = index(normal, obj_.normals.size(), largest_normal_);
        return result;
    }

    void use_material() {
        ++group_;
        const std::string name = scanner_.rest();
        const auto found = std::find(obj_.materials.begin(), obj_.materials.end(), name);
        material_ = static_cast<std::int32_t>(found - obj_.materials.begin());
        if (found == obj_.materials.end()) obj_.materials.push_back(name);
    }

    void read_face() {
        face_.clear();
        const Location where = scanner_.where();
        std::string_view word;
        while (scanner_.next_word(word))
            face_.push_back(corner(word));
        if (face_.empty()) throw InputError(where, "a face without corners", "the file is cut short: repair it");
        if (face_.size() < 3) {
            ++obj_.flat_faces;
            return;
        }
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            for (const std::size_t i : {a, b, c})
                obj_.corners.push_back(face_[i]);
            obj_.material_of.push_back(material_);
        };
        if (face_.size() == 3) {
            add(0, 1, 2);
            return;
        }
        polygon_.clear();
        for (const ObjFile::Corner& corner : face_) {
            if (corner.position >= obj_.positions.size()) return refuse_late_vertex(where);
            polygon_.push_back(obj_.positions[corner.position]);
        }
        triangles_.clear();
        if (!triangulate(polygon_, triangles_))
            throw InputError(where, "a concave face of " + std::to_string(face_.size()) + " corners",
                             "cut it into smaller ones");
        for (const auto& [a, b, c] : triangles_)
            add(a, b, c);
    }

    /// Refuses a polygon with a vertex that is not defined yet, since cutting it needs the positions. The cure depends
    /// on whether the rest of the file defines the vertex.
    void refuse_late_vertex(const Location& where) {
        std::size_t count = obj_.positions.size();
        std::string_view keyword;
        while (scanner_.next_statement(keyword))
            if (keyword == "v") ++count;
        check(largest_position_, count, "vertex");
        throw InputError(where, "a face of more than three corners uses a vertex that only follows later",
                         "put the vertices before the faces");
    }

    ObjScanner scanner_;
    ObjFile obj_;
    std::uint32_t group_ = 0;
    std::int32_t material_ = -1;
    LargestIndex largest_position_, largest_uv_, largest_normal_;
    std::vector<ObjFile::Corner> face_;
    std::vector<Vec3> polygon_;
    std::vector<std::array<std::size_t, 3>> triangles_;
};

}  // namespace

ObjFile parse_obj(std::string_view text, const std::string& file) {
    return ObjReader(text, file).read();
}

ObjFile read_obj(const std::filesystem::path& path, const Location& asked_from) {
    return parse_obj(read_input_file(path, asked_from), path.string());
}

}  // namespace treefarm
