// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/obj_materials.h"

#include <algorithm>
#include <set>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/file_search.h"

namespace treefarm::mitsuba {
namespace {

/// Index of an OBJ file's material by its name. A name that is followed by a comment is found without that, too, if no
/// material has just this name: names may hold a '#'.
std::size_t find_material(const ObjFile& obj, const std::string& name) {
    const auto& names = obj.materials;
    auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        found = std::find_if(names.begin(), names.end(), [&](const std::string& whole) {
            const std::size_t comment = whole.find(" #");
            return comment != std::string::npos && trim(std::string_view(whole).substr(0, comment)) == name;
        });
    return static_cast<std::size_t>(found - names.begin());
}

class Assignment {
  public:
    Assignment(const ObjFile& obj, Properties& properties, MaterialReader& materials, Diagnostics& diagnostics)
        : obj_(obj),
          properties_(properties),
          materials_(materials),
          diagnostics_(diagnostics),
          result_(obj.materials.size() + 1) {}

    void read_named() {
        const std::vector<Child> bsdfs = properties_.children("bsdf");
        for (const Child& bsdf : bsdfs) {
            const std::string* id = bsdf.object->find("id");
            const std::string name = !bsdf.name.empty() ? bsdf.name : id != nullptr ? *id : "";
            const std::size_t found = find_material(obj_, name);
            if (found < obj_.materials.size() && !name.empty())
                result_[found + 1].material = materials_.read(*bsdf.object);
            else if (bsdf.name.empty() || bsdfs.size() == 1)
                set_common(bsdf);
            else
                refuse_name(bsdf);
        }
    }

    /// Whether some triangles have no BSDF yet.
    bool lacks() const {
        return common_ == nullptr && std::any_of(obj_.material_of.begin(), obj_.material_of.end(), [&](std::int32_t m) {
                   return result_[static_cast<std::size_t>(std::int64_t{m} + 1)].material == kNone;
               });
    }

    void read_libraries(const std::filesystem::path& file) {
        std::set<std::string> known;
        for (const std::string& library : obj_.libraries) {
            const std::filesystem::path path = FileSearch(file.parent_path()).find(library, file.parent_path());
            std::error_code error;
            if (!std::filesystem::is_regular_file(path, error)) {
                diagnostics_.warn(properties_.where(), "the material library " + path_in_quotes(path.string()) +
                                                           " is not there: what it would colour is grey");
                continue;
            }
            diagnostics_.limits().check_file(path, properties_.where());
            for (const MtlMaterial& material : read_mtl(path, properties_.where("filename")))
                if (known.insert(material.name).second) use(material, path.parent_path());
        }
    }

    std::vector<ObjMaterial> finish(bool on_emitter) {
        const std::int32_t common = common_ != nullptr ? materials_.read(*common_) : kNone;
        for (ObjMaterial& part : result_)
            if (part.material == kNone)
                part.material = common != kNone ? common : materials_.read_default(on_emitter, properties_.where());
        return std::move(result_);
    }

  private:
    void set_common(const Child& bsdf) {
        if (common_ != nullptr)
            diagnostics_.warn(bsdf.where, properties_.title() + " has a second <bsdf>: the last one holds");
        common_ = bsdf.object;
    }

    void refuse_name(const Child& bsdf) {
        const std::string nearest = nearest_word(bsdf.name, obj_.materials);
        diagnostics_.unsupported(bsdf.where, "the OBJ file has no material " + in_quotes(bsdf.name),
                                 nearest.empty() ? "name the BSDF as usemtl does, or remove it"
                                                 : "did you mean " + in_quotes(nearest) + "?");
    }

    void use(const MtlMaterial& material, const std::filesystem::path& folder) {
        const std::size_t found = find_material(obj_, material.name);
        if (found == obj_.materials.size()) return;
        ObjMaterial& part = result_[found + 1];
        if (part.material != kNone) return;
        part.material = materials_.read_made(bsdf_of_mtl(material, folder));
        part.emission = material.emission;
        part.where = material.where;
    }

    const ObjFile& obj_;
    Properties& properties_;
    MaterialReader& materials_;
    Diagnostics& diagnostics_;
    std::vector<ObjMaterial> result_;
    const XmlElement* common_ = nullptr;
};

}  // namespace

std::vector<ObjMaterial> assign_obj_materials(const ObjFile& obj, const std::filesystem::path& file,
                                              bool load_libraries, bool on_emitter, Properties& properties,
                                              MaterialReader& materials, Diagnostics& diagnostics) {
    Assignment assignment(obj, properties, materials, diagnostics);
    if (properties.element().version >= 2) properties.only_child("bsdf");  // as in Mitsuba 3, which ignores names here
    assignment.read_named();
    if (load_libraries && assignment.lacks()) assignment.read_libraries(file);
    return assignment.finish(on_emitter);
}

const XmlElement* bsdf_of(Properties& properties, Diagnostics& diagnostics) {
    if (properties.element().version >= 2) return properties.only_child("bsdf");
    const std::vector<Child> bsdfs = properties.children("bsdf");
    if (bsdfs.size() > 1)
        diagnostics.warn(bsdfs.back().where, properties.title() + " has a second <bsdf>: the last one holds");
    return bsdfs.empty() ? nullptr : bsdfs.back().object;
}

}  // namespace treefarm::mitsuba
