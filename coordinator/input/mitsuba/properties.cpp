// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/properties.h"

#include <algorithm>
#include <array>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {
namespace {

bool is_upper(char c) {
    return 'A' <= c && c <= 'Z';
}

bool is_lower(char c) {
    return 'a' <= c && c <= 'z';
}

char to_lower(char c) {
    return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}

char to_upper(char c) {
    return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
}

constexpr std::array<std::string_view, 12> kValueTags = {"float",    "integer",   "boolean",   "string",
                                                         "point",    "vector",    "rgb",       "srgb",
                                                         "spectrum", "blackbody", "transform", "animation"};

bool is_value_tag(const std::string& tag) {
    return std::find(kValueTags.begin(), kValueTags.end(), tag) != kValueTags.end();
}

/// Cure for an unknown element: it may be a misspelt light, which must not be lost.
std::string cure_of_tag(const std::string& tag) {
    std::vector<std::string_view> tags(kValueTags.begin(), kValueTags.end());
    tags.insert(tags.end(), object_tags().begin(), object_tags().end());
    tags.emplace_back("ref");
    return did_you_mean(tag, tags, "remove it");
}

/// Effect that an unsupported object would simulate, for messages.
std::string effect_of(const std::string& tag) {
    if (tag == "medium" || tag == "phase" || tag == "volume") return " (light scattered and absorbed by a medium)";
    if (tag == "subsurface") return " (light scattered below surfaces)";
    return "";
}

/// Converts "max_depth" to "maxDepth".
std::string camel_case(const std::string& snake_case) {
    std::string result;
    for (std::size_t i = 0; i < snake_case.size(); ++i)
        if (snake_case[i] != '_') result += i > 0 && snake_case[i - 1] == '_' ? to_upper(snake_case[i]) : snake_case[i];
    return result;
}

std::string ignored(const std::string& what, const std::string& cure) {
    return what + " is ignored; " + cure;
}

}  // namespace

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), to_lower);
    return text;
}

std::string snake_case(const std::string& camel_case) {
    std::string result;
    for (std::size_t i = 0; i < camel_case.size(); ++i) {
        const bool begins_word = i > 0 && is_lower(camel_case[i - 1]) && is_upper(camel_case[i]);
        if (begins_word) result += '_';
        result += begins_word || (i > 0 && is_upper(camel_case[i - 1])) ? to_lower(camel_case[i]) : camel_case[i];
    }
    return result;
}

Properties::Properties(const XmlElement& object, const SceneDocument& document, Diagnostics& diagnostics)
    : object_(object), diagnostics_(diagnostics) {
    object.allow_attributes(object.tag == "scene" ? std::initializer_list<std::string_view>{"version", "id", "type"}
                                                  : std::initializer_list<std::string_view>{"type", "id", "name"});
    for (const XmlElement& element : object.children) {
        if (element.tag == "alias") continue;
        if (element.tag == "ref" || is_object_tag(element.tag)) {
            const std::string* name = element.find("name");
            children_.push_back({{&document.resolve(element), name ? *name : "", element.where}});
        } else if (is_value_tag(element.tag)) {
            add_value(element);
        } else {
            diagnostics.unsupported(element.where, "unknown element <" + element.tag + "> in " + title(),
                                    cure_of_tag(element.tag));
        }
    }
}

void Properties::add_value(const XmlElement& element) {
    if (element.tag == "transform") {
        element.allow_attributes({"name"});
    } else if (element.tag == "animation") {
        diagnostics_.unsupported(element.where, "motion (<animation>) is not simulated in this version",
                                 "use a <transform>", "the object stands still where it begins");
        if (element.children.empty() || element.children[0].tag != "transform")
            throw InputError(element.where, "<animation> has no transformation inside", "use a <transform>");
    } else if (!element.children.empty()) {
        throw InputError(element.children[0].where, "<" + element.tag + "> has elements inside", "remove them");
    }
    if (element.tag == "spectrum" && !element.find("value") && !element.find("filename"))
        throw InputError(element.where, "a <spectrum> without a value or a file",
                         R"(give value="..." with one number or pairs "wavelength:value", or filename="...")");
    const std::string& name = element.require("name");
    const auto [entry, is_new] = values_.emplace(snake_case(name), Value{&element});
    if (is_new) return;
    repeated(element.where, in_quotes(name) + " of " + title() + " is given twice", "remove one of them");
    entry->second = Value{&element};
}

void Properties::repeated(const Location& where, const std::string& what, const char* cure) {
    if (object_.version >= 3) throw InputError(where, what, cure);
    diagnostics_.warn(where, what + ": the last one holds");
}

std::string Properties::title() const {
    const std::string* type = object_.find("type");
    return "<" + object_.tag + (type ? " type=\"" + type->substr(0, 60) + "\"" : "") + ">";
}

std::string Properties::type() const {
    return lower_case(object_.require("type"));
}

std::string Properties::id() const {
    const std::string* id = object_.find("id");
    return id ? *id : "";
}

const Location& Properties::where(const std::string& name) const {
    const auto value = values_.find(name);
    return value == values_.end() ? object_.where : value->second.element->where;
}

const XmlElement* Properties::find(const std::string& name, std::initializer_list<std::string_view> tags,
                                   const char* kind) {
    asked_.push_back(name);
    const auto value = values_.find(name);
    if (value == values_.end()) return nullptr;
    value->second.used = true;
    const XmlElement& element = *value->second.element;
    if (std::find(tags.begin(), tags.end(), element.tag) == tags.end())
        throw InputError(element.where,
                         in_quotes(element.require("name")) + " of " + title() + " is a <" + element.tag + ">",
                         std::string("write it as ") + kind);
    return &element;
}

double Properties::number(const std::string& name, double otherwise) {
    const XmlElement* element = find(name, {"float", "integer"}, "<float>");
    if (!element) return otherwise;
    element->allow_attributes({"name", "value"});
    return number_of(element->require("value"), element->where);
}

double Properties::positive(const std::string& name, double otherwise) {
    const double value = number(name, otherwise);
    if (!(value > 0.0)) throw InputError(where(name), in_quotes(name) + " is not above 0", "give a positive number");
    return value;
}

std::int64_t Properties::integer(const std::string& name, std::int64_t otherwise) {
    const XmlElement* element = find(name, {"integer"}, "<integer>");
    if (!element) return otherwise;
    element->allow_attributes({"name", "value"});
    if (const auto value = parse_integer(element->require("value"))) return *value;
    throw InputError(element->where, in_quotes(element->require("value")) + " is not an integer", "write an integer");
}

bool Properties::boolean(const std::string& name, bool otherwise) {
    const XmlElement* element = find(name, {"boolean"}, "<boolean>");
    if (!element) return otherwise;
    element->allow_attributes({"name", "value"});
    if (const auto value = parse_boolean(lower_case(element->require("value")))) return *value;
    throw InputError(element->where, in_quotes(element->require("value")) + " is neither true nor false",
                     "write true or false");
}

std::string Properties::text(const std::string& name, const std::string& otherwise) {
    const XmlElement* element = find(name, {"string"}, "<string>");
    if (!element) return otherwise;
    element->allow_attributes({"name", "value"});
    return element->require("value");
}

Vec3 Properties::point(const std::string& name, const Vec3& otherwise) {
    const XmlElement* element = find(name, {"point", "vector"}, "<point>");
    if (!element) return otherwise;
    element->allow_attributes({"name", "x", "y", "z", "value"});
    std::vector<double> values;
    if (const std::string* list = element->find("value"))
        values = numbers_of(*list, element->where);
    else
        for (const char* axis : {"x", "y", "z"})
            values.push_back(number_of(element->require(axis), element->where));
    if (values.size() != 3)
        throw InputError(element->where,
                         in_quotes(name) + " has " + std::to_string(values.size()) + " coordinates, not 3",
                         "write x, y and z");
    return Vec3(static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]));
}

Rgb Properties::color(const std::string& name, const Rgb& otherwise, ColorUse use) {
    const XmlElement* element = find(name, {"rgb", "srgb", "spectrum", "blackbody", "float", "integer"}, "<rgb>");
    if (!element) return otherwise;
    return read_color(*element, use, diagnostics_);
}

Matrix Properties::transform(const std::string& name) {
    const XmlElement* element = find(name, {"transform", "animation"}, "<transform>");
    Matrix matrix;
    if (element) {
        const XmlElement& first = element->tag == "animation" ? element->children[0] : *element;
        matrix = read_transform(first, title() + (id().empty() ? "" : " " + in_quotes(id())));
    }
    if (name == "to_world")
        for (int i = 0; i < 3; ++i)
            matrix[3][i] += diagnostics_.world_shift[i];
    return matrix;
}

std::string Properties::tag_of(const std::string& name) const {
    const auto value = values_.find(name);
    return value == values_.end() ? "" : value->second.element->tag;
}

const XmlElement* Properties::named_child(const std::string& tag, const std::string& name) {
    asked_.push_back(name);
    const XmlElement* found = nullptr;
    for (Entry& entry : children_) {
        if (entry.child.object->tag != tag || snake_case(entry.child.name) != name) continue;
        if ((found != nullptr || has(name)) && !entry.used)
            repeated(entry.child.where, in_quotes(entry.child.name) + " of " + title() + " is given twice",
                     "remove one of them");
        // The object is used; a value beside it is superfluous.
        if (const auto value = values_.find(name); value != values_.end()) value->second.used = true;
        entry.used = true;
        found = entry.child.object;
    }
    return found;
}

std::vector<Child> Properties::children(const std::string& tag) {
    std::vector<Child> found;
    for (Entry& entry : children_)
        if (entry.child.object->tag == tag) {
            entry.used = true;
            found.push_back(entry.child);
        }
    return found;
}

const XmlElement* Properties::only_child(const std::string& tag) {
    const std::vector<Child> found = children(tag);
    if (found.size() > 1) throw InputError(found[1].where, title() + " has a second <" + tag + ">", "keep one of them");
    return found.empty() ? nullptr : found[0].object;
}

void Properties::ignore(std::initializer_list<const char*> names) {
    for (const char* name : names) {
        asked_.emplace_back(name);
        if (const auto value = values_.find(name); value != values_.end()) value->second.used = true;
    }
}

void Properties::ignore_values() {
    for (auto& [name, value] : values_)
        value.used = true;
}

void Properties::ignore_prefix(const std::string& prefix) {
    for (auto& [name, value] : values_)
        if (name.starts_with(prefix)) value.used = true;
}

void Properties::finish() {
    for (const auto& [name, value] : values_) {
        if (value.used) continue;
        const std::string nearest = nearest_word(name, asked_);
        const std::string known = is_tolerant() ? camel_case(nearest) : nearest;
        const std::string what = "unknown property " + in_quotes(value.element->require("name")) + " of " + title(),
                          cure = known.empty() ? "remove it" : "did you mean " + in_quotes(known) + "?";
        if (is_tolerant())
            diagnostics_.warn(value.element->where, ignored(what, cure));
        else
            diagnostics_.unsupported(value.element->where, what, cure);
    }
    for (const Entry& entry : children_) {
        if (entry.used) continue;
        const std::string* type = entry.child.object->find("type");
        diagnostics_.unsupported(entry.child.where,
                                 "<" + entry.child.object->tag + (type ? " type=\"" + type->substr(0, 60) + "\"" : "") +
                                     "> in " + title() + effect_of(entry.child.object->tag) +
                                     " is not available in this version",
                                 "remove it");
    }
}

}  // namespace treefarm::mitsuba
