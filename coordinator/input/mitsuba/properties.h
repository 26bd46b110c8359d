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

/// "maxDepth" -> "max_depth": the names of Mitsuba 0.5 and 0.6 in the spelling of 2 and 3.
std::string snake_case(const std::string& camel_case);

/// A text in small letters (ASCII).
std::string lower_case(std::string text);

/// An object inside another one, references resolved.
struct Child {
    const XmlElement* object;
    std::string name;  ///< of the property that it stands for: "reflectance"; mostly empty
    Location where;    ///< where it is used
};

/// Typed access to what stands inside an object's element. Names are in snake case and match both spellings. What is
/// never asked for is an error in finish(), so that a typing error does not pass unnoticed; properties in a file of
/// version 0 only get a warning, as Mitsuba 0.6 gives it.
class Properties {
  public:
    /// Wrong attributes, repeated properties and unknown elements throw InputError (or warn, when lenient). In a file
    /// of version 0 the last one of repeated properties holds, with a warning.
    Properties(const XmlElement& object, const SceneDocument& document, Diagnostics& diagnostics);

    const XmlElement& element() const { return object_; }
    const Location& where() const { return object_.where; }
    /// "<shape type="obj">", for messages.
    std::string title() const;
    /// The plugin's name, in lower case; InputError if there is none.
    std::string type() const;
    /// The id, or "".
    std::string id() const;

    bool has(const std::string& name) const { return values_.count(name) > 0; }
    /// Where the property stands, or the object itself.
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

    /// The tag of the value of this name ("float", "string"...), or "".
    std::string tag_of(const std::string& name) const;

    /// The object of a tag that stands for the property `name`, or nullptr. A second one throws InputError, or holds in
    /// a file of version 0.
    const XmlElement* named_child(const std::string& tag, const std::string& name);
    /// The objects of a tag, in their order.
    std::vector<Child> children(const std::string& tag);
    /// The only object of a tag, or nullptr; a second one throws InputError.
    const XmlElement* only_child(const std::string& tag);

    /// Properties that have no influence here: whatever they say is accepted.
    void ignore(std::initializer_list<const char*> names);

    /// Accepts all properties whose name begins so, whatever they say.
    void ignore_prefix(const std::string& prefix);
    /// Accepts all values that were not asked for yet, whatever they say.
    void ignore_values();

    /// Refuses what nobody asked for.
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
    /// The element of a property that must have one of these tags, or nullptr.
    const XmlElement* find(const std::string& name, std::initializer_list<std::string_view> tags, const char* kind);
    void add_value(const XmlElement& element);
    /// Mitsuba 0.6 warns of what later versions refuse.
    bool is_tolerant() const { return object_.version == 0; }
    /// Warns, or throws InputError, of something that was said before.
    void repeated(const Location& where, const std::string& what, const char* cure);

    const XmlElement& object_;
    Diagnostics& diagnostics_;
    std::map<std::string, Value> values_;
    std::vector<Entry> children_;
    std::vector<std::string> asked_;
};

}  // namespace treefarm::mitsuba
