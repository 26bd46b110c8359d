// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/ply_header.h"

#include <algorithm>
#include <array>

#include "common/base/error.h"
#include "common/base/text/parse_text.h"

namespace treefarm::ply {
namespace {

struct TypeName {
    std::string_view name;
    Type type;
};

constexpr std::array<TypeName, 16> kTypeNames = {{{"char", Type::int8},
                                                  {"int8", Type::int8},
                                                  {"uchar", Type::uint8},
                                                  {"uint8", Type::uint8},
                                                  {"short", Type::int16},
                                                  {"int16", Type::int16},
                                                  {"ushort", Type::uint16},
                                                  {"uint16", Type::uint16},
                                                  {"int", Type::int32},
                                                  {"int32", Type::int32},
                                                  {"uint", Type::uint32},
                                                  {"uint32", Type::uint32},
                                                  {"float", Type::float32},
                                                  {"float32", Type::float32},
                                                  {"double", Type::float64},
                                                  {"float64", Type::float64}}};

/// Limits of a header: the smallest element is one byte, and headers have a page at most in practice.
constexpr std::size_t kMaxElements = 1000, kMaxProperties = 1000;

class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    Header read() {
        if (!next_line() || words_.size() != 1 || words_[0] != "ply")
            refuse(0, "this is no PLY file: it does not begin with \"ply\"", "check the file");
        read_format();
        while (true) {
            if (!next_line()) refuse(0, "the header has no end", "the file is cut short: repair it");
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
            if (words_[0] == "end_header") break;
            if (words_[0] == "element")
                read_element();
            else if (words_[0] == "property")
                read_property();
            else
                refuse(0, in_quotes(words_[0]) + " is no statement of a PLY header", "repair the file");
        }
        header_.body = at_;
        header_.body_line = line_ + 1;
        check_counts();
        return std::move(header_);
    }

  private:
    /// `word`: index in the line, from 0 on.
    [[noreturn]] void refuse(std::size_t word, const std::string& what, const std::string& cure) const {
        const int column = word < words_.size() ? static_cast<int>(words_[word].data() - line_start_) + 1 : 1;
        throw InputError({file_, line_, column}, what, cure);
    }

    bool next_line() {
        words_.clear();
        if (at_ >= bytes_.size()) return false;
        ++line_;
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        std::string_view line = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        line_start_ = line.data();
        constexpr std::string_view blanks = " \t\r";
        for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos && words_.size() < 100;
             at = line.find_first_not_of(blanks, at)) {
            const std::size_t word_end = std::min(line.find_first_of(blanks, at), line.size());
            words_.push_back(line.substr(at, word_end - at));
            at = word_end;
        }
        return true;
    }

    void read_format() {
        while (next_line() && (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info")) {
        }
        if (words_.size() != 3 || words_[0] != "format")
            refuse(0, "the second line of a PLY file is its format", "write for instance \"format ascii 1.0\"");
        if (words_[1] == "ascii")
            header_.format = Format::ascii;
        else if (words_[1] == "binary_little_endian")
            header_.format = Format::little_endian;
        else if (words_[1] == "binary_big_endian")
            header_.format = Format::big_endian;
        else
            refuse(1, "unknown format " + in_quotes(words_[1]),
                   "it is ascii, binary_little_endian or binary_big_endian");
        if (words_[2] != "1.0") refuse(2, "unknown version " + in_quotes(words_[2]), "version 1.0 can be read");
    }

    void read_element() {
        if (words_.size() != 3) refuse(0, "an element has a name and a count", "repair the header");
        const auto count = parse_unsigned(words_[2]);
        if (!count) refuse(2, in_quotes(words_[2]) + " is no count", "give the number of elements");
        if (header_.elements.size() >= kMaxElements) refuse(0, "the file has more than 1000 kinds of elements", "");
        for (const Element& other : header_.elements)
            if (other.name == words_[1])
                refuse(1, "the element " + in_quotes(words_[1]) + " is declared twice", "rename one of them");
        header_.elements.push_back({std::string(words_[1]), *count, {}, line_});
    }

    Type type(std::size_t word) const {
        for (const TypeName& known : kTypeNames)
            if (known.name == words_[word]) return known.type;
        refuse(word, "unknown type " + in_quotes(words_[word]), "use char to double, or int8 to float64");
    }

    void read_property() {
        if (header_.elements.empty()) refuse(0, "a property stands before the first element", "repair the header");
        Element& element = header_.elements.back();
        if (element.properties.size() >= kMaxProperties) refuse(0, "an element has more than 1000 properties", "");
        Property property;
        property.line = line_;
        property.is_list = words_.size() > 1 && words_[1] == "list";
        if (words_.size() != (property.is_list ? 5u : 3u))
            refuse(0, "a property is a type and a name, or list, two types and a name", "repair the header");
        property.type = type(property.is_list ? 3 : 1);
        property.name = words_.back();
        if (property.is_list) {
            property.count_type = type(2);
            if (!is_integer(property.count_type))
                refuse(2, "the length of a list is no integer", "use an integer type");
        }
        if (element.find({property.name}))
            refuse(words_.size() - 1, "the property " + in_quotes(property.name) + " is declared twice",
                   "rename one of them");
        element.properties.push_back(std::move(property));
    }

    void check_counts() const {
        std::uint64_t remaining = bytes_.size() - header_.body + 1;  // the last line of a text may lack its line end
        for (const Element& element : header_.elements) {
            const std::size_t each = element.min_bytes(header_.format == Format::ascii);
            if (each == 0) continue;
            if (element.count > remaining / each)
                throw InputError({file_, element.line, 1},
                                 std::to_string(element.count) + " elements " + in_quotes(element.name) +
                                     " do not fit into the " + std::to_string(remaining - 1) + " bytes that follow",
                                 "the file is cut short, or its header is wrong: repair it");
            remaining -= element.count * each;
        }
    }

    std::string_view bytes_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 0;
    const char* line_start_ = nullptr;
    std::vector<std::string_view> words_;
    Header header_;
};

}  // namespace

std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

bool is_integer(Type type) {
    return type != Type::float32 && type != Type::float64;
}

std::size_t Element::min_bytes(bool ascii) const {
    std::size_t bytes = 0;
    for (const Property& property : properties)
        bytes += ascii ? 2 : size_of(property.is_list ? property.count_type : property.type);
    return bytes;
}

const Property* Element::find(std::initializer_list<std::string_view> names) const {
    for (const Property& property : properties)
        if (std::find(names.begin(), names.end(), property.name) != names.end()) return &property;
    return nullptr;
}

Header parse_header(std::string_view file_bytes, const std::string& file) {
    return HeaderReader(file_bytes, file).read();
}

}  // namespace treefarm::ply
