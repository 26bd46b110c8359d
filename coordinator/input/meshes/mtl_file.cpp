// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/mtl_file.h"

#include <algorithm>
#include <iterator>

#include "common/base/text/parse_text.h"
#include "coordinator/input/meshes/input_file.h"
#include "coordinator/input/meshes/obj_scanner.h"

namespace treefarm {
namespace {

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& file) : scanner_(text, file) {}

    std::vector<MtlMaterial> read() {
        std::string_view keyword;
        while (scanner_.next_statement(keyword)) {
            const Location where = scanner_.where();
            if (keyword == "newmtl") {
                materials_.emplace_back();
                materials_.back().name = scanner_.rest();
                materials_.back().where = where;
            }
            if (materials_.empty()) continue;
            MtlMaterial& material = materials_.back();
            if (keyword == "Kd") material.diffuse = color();
            if (keyword == "Ks") material.specular = color();
            if (keyword == "Ke") material.emission = color();
            if (keyword == "Ns") material.exponent = number(next_word());
            if (keyword == "illum") material.has_specular = number(next_word()) >= 2.0;
            if (keyword == "map_Kd") {
                material.diffuse_map = file_name();
                material.diffuse_map_where = where;
            }
        }
        return std::move(materials_);
    }

  private:
    std::string_view next_word() {
        std::string_view word;
        if (!scanner_.next_word(word))
            throw InputError(scanner_.where(), "a number is missing here", "the file is cut short: repair it");
        return word;
    }

    double number(std::string_view word) const {
        const auto value = parse_number(word);
        if (!value || !(*value >= 0.0) || *value > 1e30)
            throw InputError(scanner_.where(), in_quotes(word) + " is not a number of 0 or more",
                             "write a finite decimal number");
        return *value;
    }

    /// Three numbers, or one for grey.
    Rgb color() {
        const std::string_view first = next_word();
        if (first == "spectral" || first == "xyz")
            throw InputError(scanner_.where(), "a colour as " + std::string(first), "write red, green and blue");
        Rgb rgb(static_cast<float>(number(first)));
        std::string_view word;
        for (int c = 1; c < 3 && scanner_.next_word(word); ++c)
            rgb[c] = static_cast<float>(number(word));
        return rgb;
    }

    /// The file name after options such as "-s 1 1 1", which are skipped. A name may begin with a dash or a number.
    std::string file_name() {
        const std::string text = scanner_.rest();
        std::string_view left = text;
        while (skip_option(left)) {
        }
        return std::string(left);
    }

    static std::string_view first_word(std::string_view text) { return text.substr(0, text.find_first_of(" \t")); }

    static void skip_word(std::string_view& text) {
        text.remove_prefix(first_word(text).size());
        text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    }

    /// Removes an option of a map with its values from the beginning of a text; false if there is none.
    static bool skip_option(std::string_view& text) {
        struct Option {
            std::string_view name;
            int numbers;             ///< at most
            std::string_view words;  ///< values that are no numbers, between bars
        };
        constexpr Option kOptions[] = {{"-blendu", 0, "|on|off|"},
                                       {"-blendv", 0, "|on|off|"},
                                       {"-cc", 0, "|on|off|"},
                                       {"-clamp", 0, "|on|off|"},
                                       {"-boost", 1, ""},
                                       {"-bm", 1, ""},
                                       {"-mm", 2, ""},
                                       {"-o", 3, ""},
                                       {"-s", 3, ""},
                                       {"-t", 3, ""},
                                       {"-texres", 1, ""},
                                       {"-imfchan", 0, "|r|g|b|m|l|z|"}};
        const auto option = std::find_if(std::begin(kOptions), std::end(kOptions),
                                         [&](const Option& o) { return o.name == first_word(text); });
        if (option == std::end(kOptions)) return false;
        skip_word(text);
        for (int i = 0; i < option->numbers && parse_number(first_word(text)); ++i)
            skip_word(text);
        const std::string value = "|" + std::string(first_word(text)) + "|";
        if (value.size() > 2 && option->words.find(value) != std::string_view::npos) skip_word(text);
        return true;
    }

    ObjScanner scanner_;
    std::vector<MtlMaterial> materials_;
};

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& file) {
    return MtlReader(text, file).read();
}

std::vector<MtlMaterial> read_mtl(const std::filesystem::path& path, const Location& asked_from) {
    return parse_mtl(read_input_file(path, asked_from), path.string());
}

}  // namespace treefarm
