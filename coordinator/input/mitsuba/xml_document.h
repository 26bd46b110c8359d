// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/error.h"

namespace treefarm::mitsuba {

struct XmlAttribute {
    std::string name, value;
};

/// An element with its location in a file.
struct XmlElement {
    std::string tag;
    std::vector<XmlAttribute> attributes;
    std::vector<XmlElement> children;
    Location where;
    bool is_0_5 = false;  ///< written for Mitsuba 0.5 (or older), which evaluates spectra differently
    int version = 0;      ///< major version of the file format: 0 (Mitsuba 0.5, 0.6), 2, 3

    /// Value of the attribute, or nullptr.
    const std::string* find(std::string_view name) const;
    /// Value of the attribute. Throws InputError if it is missing.
    const std::string& require(std::string_view name) const;
    /// Throws InputError if there is an attribute with another name.
    void allow_attributes(std::initializer_list<std::string_view> names) const;
};

/// Reads an XML file into elements. `asked_from`: location of the file's name, for messages about a missing file.
/// Throws InputError for malformed XML, text between elements, nesting deeper than 100, more than 100 attributes of an
/// element, and files above 256 MiB.
XmlElement read_xml(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm::mitsuba
