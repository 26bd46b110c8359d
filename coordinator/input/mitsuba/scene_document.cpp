// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/scene_document.h"

#include <algorithm>
#include <array>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/substitution.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::size_t kMaxIncludeDepth = 15;
constexpr std::size_t kMaxIncludes = 10'000;
constexpr std::size_t kMaxElements = 10'000'000;
constexpr int kMaxReferenceDepth = 100;

/// Inserts includes and replaces $name, in document order: a <default> is valid from its position on.
class Expander {
  public:
    Expander(Parameters& parameters, FileSearch& files, const SceneLimits& limits)
        : parameters_(parameters), files_(files), limits_(limits) {}

    XmlElement read(const std::filesystem::path& path, const Location& asked_from, int version) {
        std::error_code error;
        std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
        if (error) canonical = path;
        if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
            throw InputError(asked_from, path_in_quotes(path.string()) + " includes itself, directly or through others",
                             "remove one of the includes");
        if (open_files_.size() >= kMaxIncludeDepth)
            throw InputError(asked_from, "includes are nested more than " + std::to_string(kMaxIncludeDepth) + " deep",
                             "include fewer files");
        if (++file_count_ > kMaxIncludes)
            throw InputError(asked_from, "the scene includes more than " + std::to_string(kMaxIncludes) + " files",
                             "include fewer files");
        open_files_.push_back(canonical);
        limits_.check_file(path, asked_from.file.empty() ? Location{path.string()} : asked_from);
        XmlElement root = read_xml(path, asked_from);
        const bool outer_is_0_5 = is_0_5_, outer_is_older = is_older_;
        if (root.tag == "scene") {
            version = scene_version(root);
            is_0_5_ = root.require("version") < "0.6";
            is_older_ = root.require("version") < "0.5";
        } else if (open_files_.size() == 1) {
            throw InputError(root.where, "the outermost element is <" + root.tag + ">, not <scene>",
                             "give a Mitsuba scene");
        }
        expand(root, path.parent_path(), version);
        is_0_5_ = outer_is_0_5;
        is_older_ = outer_is_older;
        open_files_.pop_back();
        return root;
    }

  private:
    static int scene_version(const XmlElement& root) {
        const std::string& text = root.require("version");
        const auto number = parse_unsigned(std::string_view(text).substr(0, text.find('.')));
        if (!number || *number == 1 || *number > 3)
            throw InputError(root.where, "unknown version " + in_quotes(text) + " of the scene format",
                             "versions 0.5, 0.6, 2 and 3 can be read");
        return static_cast<int>(*number);
    }

    void expand(XmlElement& element, const std::filesystem::path& folder, int version) {
        if (++element_count_ > kMaxElements)
            throw InputError(element.where, "the scene has more than " + std::to_string(kMaxElements) + " elements",
                             "include fewer files");
        if (is_older_ && (element.tag == "camera" || element.tag == "luminaire"))
            throw InputError(
                element.where, "the file is of Mitsuba 0.4 or older, whose <" + element.tag + "> is not read",
                "open it in Mitsuba 0.5 or 0.6, which bring it to their version: 0.5, 0.6, 2 and 3 are read");
        element.version = version;
        element.is_0_5 = is_0_5_;
        // From version 2 on a spectrum with a plugin name is an object, like a texture.
        if (version >= 2 && element.tag == "spectrum" && element.find("type") != nullptr) element.tag = "texture";
        for (XmlAttribute& attribute : element.attributes)
            attribute.value = parameters_.substitute(attribute.value, element.where);

        std::vector<XmlElement> children;
        children.reserve(element.children.size());
        for (XmlElement& child : element.children) {
            if (child.tag != "default" && child.tag != "include" && child.tag != "path") {
                expand(child, folder, version);
                children.push_back(std::move(child));
                continue;
            }
            if (!child.children.empty())
                throw InputError(child.where, "<" + child.tag + "> has elements inside", "remove them");
            for (XmlAttribute& attribute : child.attributes)
                attribute.value = parameters_.substitute(attribute.value, child.where);
            if (child.tag == "default") {
                child.allow_attributes({"name", "value"});
                parameters_.add_default(child.require("name"), child.require("value"), child.where);
            } else if (child.tag == "path") {
                if (element.tag != "scene")
                    throw InputError(child.where, "<path> stands inside <" + element.tag + ">",
                                     "put it directly into <scene>");
                child.allow_attributes({"value"});
                files_.add(child.require("value"), folder, child.where);
            } else {
                include(child, folder, version, children);
            }
        }
        element.children = std::move(children);
    }

    void include(const XmlElement& element, const std::filesystem::path& folder, int version,
                 std::vector<XmlElement>& into) {
        element.allow_attributes({"filename", "name"});
        XmlElement included = read(files_.find(element.require("filename"), folder), element.where, version);
        if (included.tag == "scene")
            std::move(included.children.begin(), included.children.end(), std::back_inserter(into));
        else
            into.push_back(std::move(included));
    }

    Parameters& parameters_;
    FileSearch& files_;
    const SceneLimits& limits_;
    std::vector<std::filesystem::path> open_files_;
    std::size_t element_count_ = 0, file_count_ = 0;
    bool is_0_5_ = false, is_older_ = false;
};

}  // namespace

std::span<const std::string_view> object_tags() {
    static constexpr std::array<std::string_view, 14> kTags = {
        "scene", "integrator", "sensor",  "film",   "rfilter", "sampler", "shape",
        "bsdf",  "emitter",    "texture", "medium", "phase",   "volume",  "subsurface"};
    return kTags;
}

bool is_object_tag(const std::string& tag) {
    const std::span<const std::string_view> tags = object_tags();
    return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

SceneDocument::SceneDocument(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                             const SceneLimits& limits) {
    Parameters parameters(defines);
    FileSearch files(path.parent_path());
    root_ = std::make_unique<XmlElement>(Expander(parameters, files, limits).read(path, Location{}, 0));
    parameters.require_all_used(root_->where);
    find_files(*root_, files, limits);
    collect_ids(*root_);
    apply_aliases(*root_);
    std::map<const XmlElement*, bool> done;
    check_references(*root_, done, 0);
}

const XmlElement& SceneDocument::resolve(const XmlElement& element) const {
    if (element.tag != "ref") return element;
    element.allow_attributes({"id", "name"});
    const std::string& id = element.require("id");
    const auto object = objects_.find(id);
    if (object != objects_.end()) return *object->second;
    std::vector<std::string> ids;
    for (const auto& [known, target] : objects_)
        ids.push_back(known);
    const std::string nearest = nearest_word(id, ids);
    throw InputError(
        element.where, "nothing in the scene has the id " + in_quotes(id),
        nearest.empty() ? "define it or remove the reference" : "did you mean " + in_quotes(nearest) + "?");
}

/// Runs after all else was read, since a <path> also applies to elements before it.
void SceneDocument::find_files(XmlElement& element, const FileSearch& files, const SceneLimits& limits) const {
    const std::string* name = element.find("name");
    const bool is_value = element.tag == "string" && name != nullptr && *name == "filename";
    for (XmlAttribute& attribute : element.attributes)
        if ((is_value && attribute.name == "value") || (element.tag == "spectrum" && attribute.name == "filename")) {
            const auto file = files.find(attribute.value, std::filesystem::path(element.where.file).parent_path());
            limits.check_file(file, element.where);
            attribute.value = file.string();
        }
    for (XmlElement& child : element.children)
        find_files(child, files, limits);
}

void SceneDocument::collect_ids(const XmlElement& element) {
    if (is_object_tag(element.tag))
        if (const std::string* id = element.find("id")) {
            const auto [entry, is_new] = objects_.emplace(*id, &element);
            if (!is_new)
                throw InputError(element.where,
                                 "the id " + in_quotes(*id) + " is taken since " + entry->second->where.text(),
                                 "rename one of them");
        }
    for (const XmlElement& child : element.children)
        collect_ids(child);
}

void SceneDocument::apply_alias(const XmlElement& alias) {
    alias.allow_attributes({"id", "as"});
    const auto object = objects_.find(alias.require("id"));
    if (object == objects_.end())
        throw InputError(alias.where, "nothing in the scene has the id " + in_quotes(alias.require("id")),
                         "define it before the alias");
    if (!objects_.emplace(alias.require("as"), object->second).second)
        throw InputError(alias.where, "the id " + in_quotes(alias.require("as")) + " is taken already",
                         "choose another");
}

void SceneDocument::apply_aliases(const XmlElement& element) {
    if (element.tag == "alias") apply_alias(element);
    for (const XmlElement& child : element.children)
        apply_aliases(child);
}

void SceneDocument::check_references(const XmlElement& element, std::map<const XmlElement*, bool>& done,
                                     int depth) const {
    if (depth > 2 * kMaxReferenceDepth)
        throw InputError(element.where,
                         "references are nested more than " + std::to_string(kMaxReferenceDepth) + " deep",
                         "refer to fewer objects in a chain");
    const auto [state, is_new] = done.emplace(&element, false);
    if (!is_new) {
        if (!state->second)
            throw InputError(element.where, "<" + element.tag + "> refers to itself, directly or through others",
                             "remove one of the references");
        return;
    }
    for (const XmlElement& child : element.children)
        check_references(resolve(child), done, depth + 1);
    done[&element] = true;
}

}  // namespace treefarm::mitsuba
