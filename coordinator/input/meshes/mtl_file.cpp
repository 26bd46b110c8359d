// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/mtl_file.h"

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

    /// The file name after options such as "-s 1 1 1", which are skipped.
    std::string file_name() {
        std::string name;
        std::string_view word;
        bool in_option = false;
        while (scanner_.next_word(word)) {
            const bool is_number = parse_number(word).has_value();
            if (name.empty() && word.size() > 1 && word[0] == '-' && !is_number) {
                in_option = true;
                continue;
            }
            if (in_option && (is_number || word == "on" || word == "off" || word.size() == 1)) continue;
            in_option = false;
            name += (name.empty() ? "" : " ") + std::string(word);
        }
        return name;
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
