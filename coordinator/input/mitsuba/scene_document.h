// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "coordinator/input/check/scene_limits.h"
#include "coordinator/input/mitsuba/file_search.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Tags of elements that are objects (not properties): they can have an id and be referred to.
std::span<const std::string_view> object_tags();
bool is_object_tag(const std::string& tag);

/// Elements of a scene, with includes inserted, every $name replaced, and every file name turned into a path that can
/// be opened.
class SceneDocument {
  public:
    /// `defines`: values for $name from outside, which override <default>. Cycles of includes or references, unknown
    /// and repeated ids, undefined $names, and defines that the scene does not use throw InputError.
    SceneDocument(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                  const SceneLimits& limits = {});

    const XmlElement& root() const { return *root_; }

    /// The object that a <ref> refers to; any other element itself.
    const XmlElement& resolve(const XmlElement& element) const;

  private:
    void find_files(XmlElement& element, const FileSearch& files, const SceneLimits& limits) const;
    void collect_ids(const XmlElement& element);
    void apply_alias(const XmlElement& alias);
    void apply_aliases(const XmlElement& element);
    void check_references(const XmlElement& element, std::map<const XmlElement*, bool>& done, int depth) const;

    std::unique_ptr<XmlElement> root_;
    std::map<std::string, const XmlElement*> objects_;
};

/// Whether an element only defines an object for references: at a scene's top level it has no effect.
bool is_definition(const XmlElement& element);

/// Objects that the scene consists of: those at its top level that are no definitions, and all that they refer to,
/// directly or indirectly. The others do not influence the image.
std::set<const XmlElement*> reachable_objects(const SceneDocument& document);

}  // namespace treefarm::mitsuba
