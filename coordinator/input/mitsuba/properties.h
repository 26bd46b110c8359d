// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coordinator/input/mitsuba/colors.h"
#include "coordinator/input/mitsuba/diagnostics.h"
#include "coordinator/input/mitsuba/scene_document.h"
#include "coordinator/input/mitsuba/transforms.h"

namespace treefarm::mitsuba {

/// Converts "maxDepth" to "max_depth": names of Mitsuba 0.5 and 0.6 in the spelling of 2 and 3.
std::string snake_case(const std::string& camel_case);

/// Text in lower case (ASCII).
std::string lower_case(std::string text);

/// An object inside another one, with references resolved.
struct Child {
    const XmlElement* object;
    std::string name;  ///< of the property it stands for: "reflectance"; mostly empty
    Location where;    ///< location of its use
};

/// Typed access to the content of an object's element. Names are in snake case and match both spellings. In finish(), a
/// property that was never asked for is an error, so that typing errors are noticed; in a file of version 0 it is only
/// a warning, as in Mitsuba 0.6.
class Properties {
  public:
    /// Wrong attributes, repeated properties and unknown elements throw InputError (or warn, when lenient). In a file
    /// of version 0 or 2 the last of repeated properties holds, with a warning.
    Properties(const XmlElement& object, const SceneDocument& document, Diagnostics& diagnostics);

    const XmlElement& element() const { return object_; }
    const Location& where() const { return object_.where; }
    /// Text "<shape type="obj">", for messages.
    std::string title() const;
    /// Name of the plugin, in lower case. Throws InputError if there is none.
    std::string type() const;
    /// The id, or "".
    std::string id() const;

    bool has(const std::string& name) const { return values_.count(name) > 0; }
    /// Location of the property, or of the object if it has no such property.
    const Location& where(const std::string& name) const;

    double number(const std::string& name, double otherwise);
    /// A number above 0.
    double positive(const std::string& name, double otherwise);
    std::int64_t integer(const std::string& name, std::int64_t otherwise);
    bool boolean(const std::string& name, bool otherwise);
    std::string text(const std::string& name, const std::string& otherwise);
    Vec3 point(const std::string& name, const Vec3& otherwise);
    Rgb color(const std::string& name, const Rgb& otherwise, ColorUse use);
    Matrix transform(const std::string& name);

    /// Tag of the value of this name ("float", "string"...), or "".
    std::string tag_of(const std::string& name) const;

    /// Object with this tag for the property `name`, or nullptr. A second one throws InputError or, in a file of
    /// version 0, replaces the first.
    const XmlElement* named_child(const std::string& tag, const std::string& name);
    /// The objects with this tag, in order.
    std::vector<Child> children(const std::string& tag);
    /// The only object with this tag, or nullptr. A second one throws InputError.
    const XmlElement* only_child(const std::string& tag);

    /// Accepts properties that have no influence, with any value.
    void ignore(std::initializer_list<const char*> names);

    /// Accepts all properties whose names begin with `prefix`, with any value.
    void ignore_prefix(const std::string& prefix);
    /// Accepts all values that were not asked for yet.
    void ignore_values();

    /// Refuses properties that were not asked for.
    void finish();

  private:
    struct Value {
        const XmlElement* element;
        bool used = false;
    };
    struct Entry {
        Child child;
        bool used = false;
    };
    /// Element of a property, which must have one of these tags; nullptr if it is absent.
    const XmlElement* find(const std::string& name, std::initializer_list<std::string_view> tags, const char* kind);
    void add_value(const XmlElement& element);
    /// Whether faults that later versions refuse give warnings, as in Mitsuba 0.6.
    bool is_tolerant() const { return object_.version == 0; }
    /// Warns of a repeated property, or throws InputError.
    void repeated(const Location& where, const std::string& what, const char* cure);

    const XmlElement& object_;
    Diagnostics& diagnostics_;
    std::map<std::string, Value> values_;
    std::vector<Entry> children_;
    std::vector<std::string> asked_;
};

}  // namespace treefarm::mitsuba
