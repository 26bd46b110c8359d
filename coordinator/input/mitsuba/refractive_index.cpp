// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/refractive_index.h"

#include <array>

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {
namespace {

struct Substance {
    const char* name;
    double index;
};

/// Names and values of Mitsuba (src/bsdfs/ior.h of 0.6, include/mitsuba/render/ior.h of 3); most are from Hecht,
/// Optics, at about 589 nm and 0 to 20 degrees Celsius.
constexpr std::array<Substance, 23> kSubstances = {
    {{"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
     {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
     {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
     {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
     {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
     {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
     {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
     {"pet", 1.5750},      {"diamond", 2.419}}};

double index_of(const std::string& name, const Location& where) {
    std::string lower = name;
    for (char& c : lower)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    std::vector<std::string> names;
    for (const Substance& substance : kSubstances) {
        if (lower == substance.name) return substance.index;
        names.emplace_back(substance.name);
    }
    const std::string nearest = nearest_word(lower, names);
    throw InputError(where, "no index of refraction is known for " + in_quotes(name),
                     nearest.empty() ? "give it as a number" : "did you mean " + in_quotes(nearest) + "?");
}

}  // namespace

double read_refractive_index(Properties& properties, const std::string& name, const std::string& otherwise) {
    if (properties.tag_of(name) != "string" && properties.has(name)) {
        const double index = properties.positive(name, 1.0);
        if (index > 100.0)
            throw InputError(properties.where(name), "an index of refraction of " + number_text(index),
                             "give at most 100");
        return index;
    }
    return index_of(properties.text(name, otherwise), properties.where(name));
}

float read_relative_index(Properties& properties, const std::string& inside_otherwise) {
    const double inside = read_refractive_index(properties, "int_ior", inside_otherwise);
    return static_cast<float>(inside / read_refractive_index(properties, "ext_ior", "air"));
}

}  // namespace treefarm::mitsuba
