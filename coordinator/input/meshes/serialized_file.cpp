// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/serialized_file.h"

#include <cmath>
#include <fstream>
#include <limits>

#include "common/base/bytes.h"
#include "common/base/text/parse_text.h"
#include "coordinator/input/meshes/inflater.h"
#include "coordinator/input/meshes/input_file.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kHasNormals = 0x1, kHasUvs = 0x2, kHasColors = 0x8, kDouble = 0x2000;
constexpr std::uint16_t kMagic = 0x041C;
constexpr std::size_t kMaxName = 65536;

/// Reads versions and offsets in the file itself.
class Container {
  public:
    Container(std::istream& in, std::uint64_t size, const std::string& file) : in_(in), size_(size), file_(file) {}

    /// Version of the mesh that begins at a byte.
    std::uint16_t version_at(std::uint64_t offset) {
        if (get<std::uint16_t>(offset) != kMagic)
            refuse(offset, "there is no serialized mesh", "check that the file is Mitsuba's serialized format");
        const auto version = get<std::uint16_t>(offset + 2);
        if (version != 3 && version != 4)
            refuse(offset + 2, "unknown version " + std::to_string(version) + " of the serialized format",
                   "versions 3 and 4 can be read");
        return version;
    }

    /// Offset of mesh number `index`, from the table at the end of the file.
    std::uint64_t offset_of(std::int64_t index, std::uint16_t version, const Location& where) {
        if (index == 0) return 0;
        if (size_ < 8) refuse(0, "the file is cut short", "repair it");
        const auto count = get<std::uint32_t>(size_ - 4);
        const std::uint64_t each = version == 4 ? 8 : 4;
        if (count > (size_ - 4) / each)
            refuse(size_ - 4, "the table of " + std::to_string(count) + " meshes does not fit into the file",
                   "the file is cut short: repair it");
        if (index < 0 || index >= std::int64_t{count})
            throw InputError(where, "mesh number " + std::to_string(index) + " of " + std::to_string(count),
                             "give a shape index from 0");
        const std::uint64_t entry = size_ - 4 - each * (count - static_cast<std::uint64_t>(index));
        return version == 4 ? get<std::uint64_t>(entry) : get<std::uint32_t>(entry);
    }

    [[noreturn]] void refuse(std::uint64_t offset, const std::string& what, const std::string& cure) const {
        throw InputError(Location{file_}, what + " (at byte " + std::to_string(offset) + ")", cure);
    }

  private:
    template <class T>
    T get(std::uint64_t offset) {
        if (offset > size_ || size_ - offset < sizeof(T))
            refuse(offset, "the file ends before a value that it needs", "the file is cut short: repair it");
        T value;
        in_.seekg(static_cast<std::streamoff>(offset));
        in_.read(reinterpret_cast<char*>(&value), sizeof(T));
        if (!in_) refuse(offset, "the file cannot be read", "check its permissions");
        return value;
    }

    std::istream& in_;
    std::uint64_t size_;
    const std::string& file_;
};

/// Appends `count` vectors in pieces, so that memory grows only with data that exist.
template <class V>
void read_vectors(Inflater& in, bool is_double, std::uint64_t count, std::vector<V>& values) {
    constexpr std::size_t n = V::dimensions(), piece = 4096;
    std::vector<double> doubles(is_double ? piece * n : 0);
    std::vector<float> floats(piece * n);
    for (std::uint64_t done = 0; done < count;) {
        const auto now = static_cast<std::size_t>(std::min<std::uint64_t>(piece, count - done));
        if (is_double) {
            in.read(doubles.data(), now * n * sizeof(double));
            for (std::size_t i = 0; i < now * n; ++i)
                floats[i] = std::abs(doubles[i]) <= double(std::numeric_limits<float>::max())
                                ? static_cast<float>(doubles[i])
                                : std::numeric_limits<float>::infinity();
        } else {
            in.read(floats.data(), now * n * sizeof(float));
        }
        for (std::size_t i = 0; i < now; ++i) {
            V v;
            for (std::size_t k = 0; k < n; ++k) {
                v[static_cast<int>(k)] = floats[n * i + k];
                if (!std::isfinite(floats[n * i + k]))
                    in.refuse("vertex " + std::to_string(done + i) + " has a value that is not finite",
                              "repair the file");
            }
            values.push_back(v);
        }
        done += now;
    }
}

void read_indices(Inflater& in, std::uint64_t triangle_count, Mesh& mesh) {
    std::vector<std::uint32_t> piece(3 * 4096);
    for (std::uint64_t left = 3 * triangle_count; left > 0;) {
        const auto now = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), left));
        in.read(piece.data(), now * sizeof(std::uint32_t));
        for (std::size_t i = 0; i < now; ++i)
            if (piece[i] >= mesh.positions.size())
                in.refuse("vertex " + std::to_string(piece[i]) + " of " + std::to_string(mesh.positions.size()),
                          "repair the file");
        mesh.indices.insert(mesh.indices.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(now));
        left -= now;
    }
}

Mesh read_mesh(Inflater& in, std::uint16_t version) {
    const auto flags = in.get<std::uint32_t>();
    if (version == 4) {
        std::size_t length = 0;
        while (in.get<char>() != '\0')
            if (++length > kMaxName) in.refuse("the mesh's name has no end", "repair the file");
    }
    const auto vertex_count = in.get<std::uint64_t>(), triangle_count = in.get<std::uint64_t>();
    const bool is_double = (flags & kDouble) != 0;
    const std::uint64_t floats_each =
        3u + (flags & kHasNormals ? 3u : 0u) + (flags & kHasUvs ? 2u : 0u) + (flags & kHasColors ? 3u : 0u);
    const std::uint64_t bytes_each = floats_each * (is_double ? 8 : 4);
    if (vertex_count >= std::uint64_t{1} << 31 || triangle_count >= std::uint64_t{1} << 31)
        in.refuse("more than 2^31 vertices or triangles", "split the mesh, or repair the file");
    if (vertex_count * bytes_each + triangle_count * 12 > in.most_left())
        in.refuse(std::to_string(vertex_count) + " vertices and " + std::to_string(triangle_count) +
                      " triangles do not fit into the file",
                  "the file is cut short or damaged: repair it");
    // Meshes pack by a factor of some ten; a file of zeros would cost its reader minutes.
    constexpr std::uint64_t kSmall = std::uint64_t{1} << 26, kMostPacking = 100;
    const std::uint64_t needed = vertex_count * bytes_each + triangle_count * 12;
    if (needed > kSmall && needed / kMostPacking > in.packed_left())
        in.refuse(std::to_string(vertex_count) + " vertices and " + std::to_string(triangle_count) +
                      " triangles are packed into " + std::to_string(in.packed_left()) + " bytes",
                  "no mesh packs so well: check what wrote it");
    Mesh mesh;
    read_vectors(in, is_double, vertex_count, mesh.positions);
    if (flags & kHasNormals) read_vectors(in, is_double, vertex_count, mesh.normals);
    if (flags & kHasUvs) read_vectors(in, is_double, vertex_count, mesh.uvs);
    if (flags & kHasColors) read_vectors(in, is_double, vertex_count, mesh.add_attribute("vertex_color").values);
    read_indices(in, triangle_count, mesh);
    in.finish();
    return mesh;
}

Mesh parse(std::istream& in, std::uint64_t size, std::int64_t index, const std::string& file, const Location& where) {
    Container container(in, size, file);
    const std::uint64_t offset = container.offset_of(index, container.version_at(0), where);
    const std::uint16_t version = container.version_at(offset);
    in.seekg(static_cast<std::streamoff>(offset + 4));
    Inflater inflater(in, size - offset - 4, file);
    return read_mesh(inflater, version);
}

}  // namespace

Mesh parse_serialized(std::istream& in, std::uint64_t size, std::int64_t index, const std::string& file) {
    return parse(in, size, index, file, Location{file});
}

Mesh read_serialized(const std::filesystem::path& path, std::int64_t index, const Location& asked_from) {
    const std::uint64_t size = input_file_size(path, asked_from);
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(asked_from, path_in_quotes(path.string()) + " cannot be read", "check its permissions");
    return parse(in, size, index, path.string(), asked_from);
}

}  // namespace treefarm
