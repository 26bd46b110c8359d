// SPDX-License-Identifier: Apache-2.0
#include "common/scene/kinds/kind_documentation.h"

#include "common/base/text/parse_text.h"
#include "common/scene/kinds/emitters.h"
#include "common/scene/kinds/kind_name.h"
#include "common/scene/kinds/materials.h"
#include "common/scene/kinds/shapes.h"
#include "common/scene/kinds/textures.h"

namespace treefarm {
namespace {

/// Visitor that documents a kind's values and its rules.
class DescribeFields {
  public:
    const std::string& values() const { return values_; }
    const std::string& rules() const { return rules_; }

    void flag(const char* name, bool) { add(name, "flag"); }
    void choice(const char* name, auto, auto last) {
        add(name, "one of " + std::to_string(static_cast<int>(last) + 1));
    }
    void rule(bool, const char* what, const char*) {
        // The text of a shape's rule continues its name.
        const std::string text(what);
        rules_ += (rules_.empty() ? "" : "; ") + (text.starts_with("has ") ? "it " + text : text);
    }

    void fraction(const char* name, const auto& input) { add(name, textured(input) + ", 0 to 1"); }
    void anisotropy(const FloatInput& input) { add("anisotropy", textured(input) + ", 0 to 1"); }
    void number(const char* name, const auto& input, float least, float most) {
        add(name, textured(input) + ", " + number_text(least) + " to " + number_text(most));
    }
    void together(const auto&, const auto&) {
        rule(true, "not refused but scaled: two colours that add up to more than 1", "");
    }
    void eta(float) { add("eta", "above 0"); }
    void metal(const Rgb&, const Rgb&) {
        add("eta", "colour, 0 to 1e6");
        add("k", "colour, 0 to 1e6");
    }
    void roughness(const Roughness&, bool isotropic) {
        add("distribution", "one of the microfacet distributions");
        add("alpha", isotropic ? "number or texture, above 0" : "two numbers or textures, above 0");
    }
    void part(const char* name, std::int32_t) { add(name, "a material that stands before"); }

    void light(const char* name, const Rgb&) { add(name, "colour, 0 or more"); }
    void light(const char* name, const ColorInput&) { add(name, "colour or texture, 0 or more"); }
    void light(const char* name, float) { add(name, "0 or more"); }
    void position(const Vec3&) { add("position", "point"); }
    void direction(const Vec3&) { add("direction", "unit vector"); }
    void value(float) { add("number", "see the rules"); }
    void texture(std::int32_t) { add("texture", "one, or none"); }
    void image(std::int32_t) { add("image", "one"); }
    void shape(std::int32_t) { add("shape", "the one that shines"); }

    void color(const char* name, const Rgb&) { add(name, "colour"); }
    void extent(const char* name, float) { add(name, "0 or more"); }
    void coordinates(const UvTransform&) { add("coordinates", "two rows of three numbers"); }
    void mesh_attribute(const std::string&) { add("attribute", "name"); }

    void point(const char* name, const Vec3&) { add(name, "point"); }
    void offset(const char* name, const Vec3&) { add(name, "vector"); }
    void axis(const char* name, const Vec3&) { add(name, "unit vector"); }
    void radius(float) { add("radius", "above 0"); }
    void group(std::int32_t) { add("group", "one that has shapes"); }
    void transform(const Imath::M44f&) { add("transform", "affine, can be inverted"); }
    void vertices(const auto&) { add("vertices", "points"); }
    void per_vertex(const char* name, const auto&) { add(std::string(name) + "s", "one for each vertex, or none"); }
    void triangles(const auto&) { add("triangles", "three vertices each; one has an area"); }
    void attributes(const auto&) { add("attributes", "a name, and a colour for each vertex or triangle"); }

  private:
    static std::string textured(const ColorInput&) { return "colour or texture"; }
    static std::string textured(const FloatInput&) { return "number or texture"; }

    void add(const std::string& name, const std::string& what) {
        values_ += (values_.empty() ? "" : "; ") + name + " (" + what + ")";
    }

    std::string values_, rules_;
};

template <class Variant>
std::string table_of(const std::string& family) {
    std::string table = "\n## " + family + "\n\n| kind | values | refused where |\n|---|---|---|\n";
    for_each_kind<Variant>([&]<class Kind>() {
        DescribeFields fields;
        const Kind kind;
        Kind::fields(kind, fields);
        table += "| `" + kind_name<Kind>() + "` | " + fields.values() + " | " + fields.rules() + " |\n";
    });
    return table;
}

}  // namespace

std::string kind_documentation() {
    return table_of<ShapeKind>("Shapes") + table_of<MaterialKind>("Materials") + table_of<EmitterKind>("Emitters") +
           table_of<TextureKind>("Textures");
}

}  // namespace treefarm
