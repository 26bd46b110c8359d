// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/xml_document.h"

#include <algorithm>
#include <fstream>
#include <pugixml.hpp>

#include "common/base/text/parse_text.h"
#include "coordinator/input/images/lfs_pointer.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{256} << 20;
constexpr int kMaxDepth = 100;
constexpr std::size_t kMaxAttributes = 100;

/// Maps byte offsets to lines and columns.
class LineTable {
  public:
    explicit LineTable(const std::string& text) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts_.push_back(i + 1);
    }

    Location locate(const std::string& file, std::ptrdiff_t offset) const {
        if (offset < 0) return {file};
        const auto at = static_cast<std::size_t>(offset);
        const auto next = std::upper_bound(starts_.begin(), starts_.end(), at);
        return {file, static_cast<int>(next - starts_.begin()), static_cast<int>(at - *(next - 1)) + 1};
    }

  private:
    std::vector<std::size_t> starts_{0};
};

std::string read_text(const std::filesystem::path& path, const Location& asked_from) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw InputError(asked_from, "there is no file " + path_in_quotes(path.string()), "check the path");
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(asked_from, path_in_quotes(path.string()) + " is not a file", "check the path");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > kMaxFileBytes)
        throw InputError({path.string()}, "the XML file has more than 256 MiB", "move meshes into files of their own");
    std::string text(static_cast<std::size_t>(size), '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(text.data(), static_cast<std::streamsize>(size));
    if (!in || in.gcount() != static_cast<std::streamsize>(size))
        throw InputError({path.string()}, "the file cannot be read", "check its permissions");
    if (is_lfs_pointer(text)) throw InputError({path.string()}, kLfsPointer, kLfsCure);
    return text;
}

struct Converter {
    const std::string& file;
    const LineTable& lines;

    Location locate(const pugi::xml_node& node) const {
        // pugixml points at the name; the element begins at the bracket before it.
        const std::ptrdiff_t offset = node.offset_debug();
        return lines.locate(file, node.type() == pugi::node_element ? offset - 1 : offset);
    }

    XmlElement convert(const pugi::xml_node& node, int depth) const {
        XmlElement element;
        element.tag = node.name();
        element.where = locate(node);
        if (depth > kMaxDepth)
            throw InputError(element.where, "elements are nested more than " + std::to_string(kMaxDepth) + " deep",
                             "no scene needs that: repair the file");
        for (const pugi::xml_attribute& attribute : node.attributes()) {
            if (element.find(attribute.name()) != nullptr)
                throw InputError(element.where,
                                 "<" + element.tag + "> has the attribute " + in_quotes(attribute.name()) + " twice",
                                 "keep one of them");
            if (element.attributes.size() >= kMaxAttributes)
                throw InputError(
                    element.where,
                    "<" + element.tag + "> has more than " + std::to_string(kMaxAttributes) + " attributes",
                    "no element needs that: repair the file");
            element.attributes.push_back({attribute.name(), attribute.value()});
        }
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() == pugi::node_element)
                element.children.push_back(convert(child, depth + 1));
            else if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
                throw InputError(locate(child), "text " + in_quotes(trim(child.value())) + " stands between elements",
                                 R"(put values into attributes, as in <float name="fov" value="45"/>)");
        }
        return element;
    }
};

}  // namespace

const std::string* XmlElement::find(std::string_view name) const {
    for (const XmlAttribute& attribute : attributes)
        if (attribute.name == name) return &attribute.value;
    return nullptr;
}

const std::string& XmlElement::require(std::string_view name) const {
    if (const std::string* value = find(name)) return *value;
    throw InputError(where, "<" + tag + "> has no attribute \"" + std::string(name) + "\"", "add it");
}

void XmlElement::allow_attributes(std::initializer_list<std::string_view> names) const {
    for (const XmlAttribute& attribute : attributes)
        if (std::find(names.begin(), names.end(), attribute.name) == names.end())
            throw InputError(where, "<" + tag + "> has the unknown attribute " + in_quotes(attribute.name),
                             did_you_mean(attribute.name, std::span(names.begin(), names.size()), "remove it"));
}

XmlElement read_xml(const std::filesystem::path& path, const Location& asked_from) {
    const std::string file = path.string();
    const std::string text = read_text(path, asked_from);
    const LineTable lines(text);
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_auto);
    if (!result) {
        if (result.status == pugi::status_no_document_element)
            throw InputError({file}, "the file has no XML element",
                             "give a scene that begins with <scene version=\"...\">");
        const auto end = static_cast<std::ptrdiff_t>(text.size());
        throw InputError(lines.locate(file, std::min(result.offset, end)),
                         "this is not well-formed XML (" + std::string(result.description()) + ")", "repair the file");
    }
    const Converter converter{file, lines};
    XmlElement root;
    for (const pugi::xml_node& node : document.children()) {
        if (node.type() != pugi::node_element) continue;
        if (!root.tag.empty())
            throw InputError(converter.locate(node), "a second outermost element <" + std::string(node.name()) + ">",
                             "put everything into one <scene>");
        root = converter.convert(node, 1);
    }
    return root;
}

}  // namespace treefarm::mitsuba
