// SPDX-License-Identifier: Apache-2.0
// What a refusal says to do must help: every cure that can be applied without thought is applied, and the scene read
// again.
#include <optional>

#include "tests/support/cures.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

std::string shape(const std::string& inside) {
    return "<shape type=\"rectangle\">\n" + inside + "\n</shape>";
}
std::string bsdf_scene(const std::string& type, const std::string& inside) {
    return shape("<bsdf type=\"" + type + "\">\n" + inside + "\n</bsdf>");
}
std::string emitter(const std::string& type, const std::string& inside) {
    return "<emitter type=\"" + type + "\">\n" + inside + "\n</emitter>";
}
std::string film(const std::string& inside) {
    return "<sensor type=\"perspective\">\n<film type=\"hdrfilm\">\n" + inside + "\n</film></sensor>";
}
std::string filter(const std::string& type, const std::string& inside) {
    return film("<rfilter type=\"" + type + "\">\n" + inside + "\n</rfilter>");
}
std::string lens(const std::string& type, const std::string& inside) {
    return "<sensor type=\"" + type + "\">\n" + inside + "\n</sensor>";
}
std::string guided(const std::string& inside) {
    return "<integrator type=\"guided_path\">\n" + inside + "\n</integrator>";
}
std::string value(const std::string& tag, const std::string& name, const std::string& what) {
    return "<" + tag + " name=\"" + name + "\" value=\"" + what + "\"/>";
}
std::string bitmap(const std::string& inside, const std::string& name = "reflectance") {
    return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"a.ppm\"/>\n" + inside +
           "</texture>";
}
std::string moved(const std::string& step) {
    return "<transform name=\"toWorld\">\n" + step + "</transform>";
}
std::string blend(const std::string& first, const std::string& second) {
    return bsdf_scene("blendbsdf", value("float", "weight", "0.5") + first + second);
}
const std::string kDiffuse = "<bsdf type=\"diffuse\"/>", kGlass = "<bsdf type=\"dielectric\"/>";
const std::string kBump = "<bsdf type=\"bumpmap\">" + bitmap("", "map") + kDiffuse + "</bsdf>";
const std::string kTwosided = "<bsdf type=\"twosided\">" + kDiffuse + "</bsdf>";
const std::string kFaces = "<bsdf type=\"twosided\">" + kDiffuse + "<bsdf type=\"plastic\"/></bsdf>";

/// Scenes with one fault each, for both versions unless it says otherwise. Such a fault whose cure is mechanical
/// belongs here (the last test sees what is missing).
struct Fault {
    std::string body;
    const char* versions = "03";
};

std::vector<Fault> faults() {
    return {
        // emitters
        {emitter("point", value("point", "position", "0 0 1") + "\n" + moved("<translate x=\"1\"/>"))},
        {emitter("spot", value("float", "cutoffAngle", "200"))},
        {emitter("spot", value("float", "beamWidth", "30"))},
        {emitter("directional", value("vector", "direction", "0 0 1") + moved("<translate x=\"1\"/>"))},
        {emitter("envmap", value("string", "filename", "a.ppm") + value("float", "scale", "-1"))},
        {emitter("envmap", value("string", "filename", "a.ppm") + "\n" + moved("<scale value=\"2\"/>"))},
        {emitter("projector", moved("<scale value=\"2\"/>")), "3"},
        {emitter("projector", value("float", "scale", "-1")), "3"},
        {shape(emitter("spot", ""))},
        {emitter("area", "")},
        {emitter("collimated", ""), "3"},
        {emitter("spott", "")},
        {emitter("constant", "") + "\n" + emitter("constant", "")},
        {emitter("sky", value("float", "turbidity", "0"))},
        {emitter("sky", value("integer", "resolution", "0"))},
        {emitter("sun", value("vector", "sunDirection", "0 1 0") + "\n" + value("float", "hour", "12")), "0"},
        {emitter("point", value("rgb", "intensity", "-1"))},
        {emitter("point", "<blackbody name=\"intensity\" temperature=\"-1\"/>")},
        // films and sensors
        {filter("mitchell", value("float", "B", "20"))},
        {filter("box", value("float", "radius", "0"))},
        {filter("lanczos", value("integer", "lobes", "0"))},
        {filter("blackman", "")},
        {filter("gausian", "")},
        {film(value("integer", "width", "0"))},
        {film(value("integer", "cropOffsetX", "-1"))},
        {"<sensor type=\"perspective\">\n<film type=\"mfilm\"/></sensor>"},
        {"<sensor type=\"perspective\">\n<film type=\"hdr_film\"/></sensor>"},
        {lens("perspective", value("float", "fov", "200"))},
        {lens("perspective", value("float", "fov", "40") + "\n" + value("string", "fovAxis", "z"))},
        {lens("perspective", value("float", "fov", "40") + "\n" + value("string", "focalLength", "50mm"))},
        {lens("perspective", moved("<scale x=\"2\"/>"))},
        {lens("thinlens", "")},
        {lens("thinlens", value("float", "apertureRadius", "-1"))},
        {lens("thinlens", value("float", "apertureRadius", "1") + value("float", "focusDistance", "-1"))},
        {lens("fisheye", "")},
        {lens("perspectiv", "")},
        {"<integrator type=\"path\"/>", "3"},
        // integrators
        {"<integrator type=\"foo\"/>"},
        {"<integrator type=\"pth\"/>"},
        {"<integrator type=\"aov\">\n" + value("string", "aovs", "a:foo") + "\n</integrator>", "3"},
        {guided(value("string", "nee", "foo"))},
        {guided(value("string", "bsdfSamplingFractionLoss", "foo"))},
        {guided(value("float", "budget", "-1"))},
        {guided(value("string", "budgetType", "spp") + value("float", "budget", "0.5"))},
        {guided(value("string", "budgetType", "foo"))},
        // materials
        {bsdf_scene("foo", "")},
        {bsdf_scene("difuse", "")},
        {bsdf_scene("irawan", "")},
        {bsdf_scene("hk", value("string", "material", "ketchupp"))},
        {bsdf_scene("hk", value("float", "sigmaT", "1"))},
        {bsdf_scene("hk", value("string", "material", "ketchup") + value("float", "sigmaS", "1"))},
        {bsdf_scene("hk",
                    value("float", "sigmaA", "1") + value("float", "sigmaT", "1") + value("float", "albedo", "1"))},
        {bsdf_scene("hk", "<phase type=\"rayleigh\"/>")},
        {bsdf_scene("hk", "<phase type=\"hg\">" + value("float", "g", "1") + "</phase>")},
        {bsdf_scene("ward", value("string", "variant", "new"))},
        {bsdf_scene("principled", value("float", "specular", "2")), "3"},
        {bsdf_scene("coating", value("float", "thickness", "-1") + kDiffuse)},
        {bsdf_scene("twosided", value("boolean", "allowTransmission", "true") + kDiffuse), "3"},
        {bsdf_scene("twosided", kGlass)},
        {bsdf_scene("twosided", kDiffuse + kGlass)},
        {bsdf_scene("mask", value("float", "opacity", "2") + kDiffuse)},
        {bsdf_scene("mask",
                    bitmap("", "opacity") + "<bsdf type=\"mask\">" + bitmap("", "opacity") + kDiffuse + "</bsdf>")},
        {bsdf_scene("bumpmap", bitmap("", "map") + kBump)},
        {blend(kDiffuse, kTwosided)},
        {blend(kFaces, kFaces)},
        {bsdf_scene("blendbsdf", value("float", "weight", "2") + kDiffuse + kDiffuse)},
        {bsdf_scene("mixturebsdf", value("string", "weights", "-1, 0.5") + kDiffuse + kDiffuse)},
        {bsdf_scene("mixturebsdf", value("string", "weights", "0") + kDiffuse)},
        {bsdf_scene("diffuse", value("rgb", "reflectance", "-1"))},
        {bsdf_scene("diffuse", value("rgb", "reflectance", "2")), "3"},
        {bsdf_scene("dielectric", value("string", "intIOR", "watr"))},
        {bsdf_scene("dielectric", value("float", "intIOR", "200"))},
        {bsdf_scene("conductor",
                    value("string", "material", "Au") + "\n" + value("rgb", "eta", "1") + value("rgb", "k", "1")),
         "3"},
        {bsdf_scene("conductor", value("string", "material", "Aau"))},
        {bsdf_scene("roughconductor", value("float", "alpha", "-1"))},
        {bsdf_scene("roughconductor", value("string", "distribution", "phong"))},
        {bsdf_scene("roughconductor", value("string", "distribution", "foo"))},
        // textures
        {bsdf_scene("diffuse", bitmap(value("string", "wrapMode", "foo")))},
        {bsdf_scene("diffuse", bitmap(value("string", "filterType", "foo")))},
        {bsdf_scene("diffuse", bitmap(value("string", "coordinates", "foo"))), "0"},
        {bsdf_scene("diffuse", bitmap(value("string", "channel", "z"))), "0"},
        {bsdf_scene("diffuse", bitmap(value("float", "gamma", "-3"))), "0"},
        {bsdf_scene("diffuse", "<texture type=\"foo\" name=\"reflectance\"/>")},
        {bsdf_scene("diffuse", "<texture type=\"unifrm\" name=\"reflectance\"/>")},
        {bsdf_scene("diffuse", "<texture type=\"checkerbord\" name=\"reflectance\"/>")},
        {emitter("point", bitmap("", "intensity"))},
        // shapes
        {"<shape type=\"foo\"/>"},
        {"<shape type=\"sphree\"/>"},
        {"<shape type=\"merge\"><shape type=\"instance\"/></shape>", "0"},
        {"<shape type=\"shapegroup\" id=\"g\">" + shape(emitter("area", "")) +
         "</shape><shape type=\"instance\"><ref id=\"g\"/></shape>"},
        {"<shape type=\"shapegroup\" id=\"g\"/><shape type=\"instance\"><ref id=\"g\"/></shape>"},
        {"<shape type=\"obj\">" + value("string", "filename", "a.obj") + value("integer", "shapeIndex", "7") +
             "</shape>",
         "0"},
        {"<shape type=\"obj\">" + value("string", "filename", "a.obj") + "\n" +
             value("boolean", "faceNormals", "true") + "\n" + value("float", "maxSmoothAngle", "30") + "</shape>",
         "0"},
        {"<shape type=\"obj\">" + value("string", "filename", "a.obj") +
             "<bsdf name=\"rad\" type=\"diffuse\"/><bsdf name=\"blue\" type=\"diffuse\"/></shape>",
         "0"},
        // any object
        {shape("<foo/>")},
        {shape("<medium type=\"homogeneous\" name=\"interior\"/>")},
        {shape("<animation name=\"toWorld\"><transform><translate x=\"1\"/></transform></animation>"), "0"},
        {"<shape type=\"sphere\">\n<float name=\"radius\" value=\"1\"><foo/></float></shape>"},
        {"<shape type=\"sphere\">" + value("float", "radius", "1") + "\n" + value("float", "radius", "2") + "</shape>",
         "3"},
        {"<shape type=\"sphere\">" + value("float", "radius", "foo") + "</shape>"},
        {"<shape type=\"sphere\"><float name=\"radius\" foo=\"2\" value=\"1\"/></shape>"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/><float name=\"radius\"/></shape>", "3"},
        {film(value("integer", "width", "1.5"))},
        {shape(value("boolean", "flipNormals", "maybe"))},
        {shape(kDiffuse + "\n" + kDiffuse), "3"},
        {shape(value("float", "magic", "1")), "3"},
        {shape(value("boolean", "flip_normal", "true")), "3"},
        {shape("<ref id=\"reed\"/>") + "<bsdf type=\"diffuse\" id=\"red\"/>"},
        {shape(moved("<foo/>"))},
        {shape(moved("<translate x=\"1\"><foo/></translate>"))},
    };
}

class MitsubaCures : public MitsubaFixture {
  protected:
    void SetUp() override {
        MitsubaFixture::SetUp();
        write("a.ppm", "P6 1 1 255\nabc");
        write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
        write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 2 4 3\n");
    }

    static std::string document(const std::string& body, char version) {
        const bool has_sensor = body.find("<sensor") != std::string::npos || body == "<integrator type=\"path\"/>";
        // Without an emitter a scene of 0.6 gets a sky, which takes longer to compute than all else.
        return std::string("<scene version=\"") + (version == '0' ? "0.6.0" : "3.0.0") + "\">" +
               (version == '0' && body.find("<emitter") == std::string::npos ? "<emitter type=\"point\"/>" : "") +
               "\n" + (has_sensor ? "" : "<sensor type=\"perspective\"/>\n") + body + "\n</scene>\n";
    }

    std::optional<InputError> refusal(const std::string& text, bool lenient = false) const {
        try {
            load_scene(write("scene.xml", text), {}, lenient);
        } catch (const InputError& error) {
            return error;
        }
        return std::nullopt;
    }

    /// A cure may lead on to what the new thing lacks (a bitmap its file); to nothing else.
    static bool only_lacks_content(const InputError& error) {
        return (error.problem().find(" has no ") != std::string::npos ||
                error.problem().find(" places no ") != std::string::npos) &&
               (error.cure().starts_with("add ") || error.cure().starts_with("put ") ||
                error.cure().starts_with("give "));
    }

    /// Promises of a cure that it does not keep, one line for each; empty if it helps.
    std::string broken_promises(const std::string& text, const InputError& error) const {
        std::string broken;
        for (const Cured& cured : apply_cure(text, error)) {
            const auto left = cured.document.empty() ? error : refusal(cured.document);
            if (left && !(cured.step.starts_with("the word") && only_lacks_content(*left)))
                broken += std::string(error.what()) + "\n  " + cured.step + ": " + left->what() + "\n";
        }
        if (error.cure().find("with --lenient") != std::string::npos)
            if (const auto left = refusal(text, true))
                broken += std::string(error.what()) + "\n  with --lenient: " + left->what() + "\n";
        return broken;
    }
};

TEST_F(MitsubaCures, Help) {
    for (const Fault& fault : faults())
        for (const char version : std::string(fault.versions)) {
            const std::string text = document(fault.body, version);
            const auto error = refusal(text);
            EXPECT_TRUE(error) << "no fault in version " << version << ":\n" << text;
            if (!error) continue;
            EXPECT_EQ(broken_promises(text, *error), "") << "version " << version << ":\n" << text;
        }
}

TEST_F(MitsubaCures, WrongOnesAreFound) {
    const std::string text = document(bsdf_scene("diffuse", bitmap(value("string", "filterType", "foo"))), '3');
    const auto real = refusal(text);
    ASSERT_TRUE(real);
    EXPECT_EQ(broken_promises(text, *real), "");
    for (const char* wrong : {"use neerest or bilinear", "did you mean \"ewaa\"?", "give 0 to 1",
                              "use bilinear or cubic", "use nearest (with --lenient it is skipped)"})
        EXPECT_NE(broken_promises(text, InputError(real->where(), real->problem(), wrong)), "") << wrong;
    EXPECT_EQ(broken_promises(text, InputError(real->where(), real->problem(), "remove it")), "");
    EXPECT_NE(broken_promises(text, InputError({"", 2, 1}, real->problem(), "remove it")), "") << "at the wrong place";
}

/// A cure that is new in the reader and mechanical has to be tried above.
TEST_F(MitsubaCures, AreAllTried) {
    std::string tried;
    for (const Fault& fault : faults())
        for (const char version : std::string(fault.versions))
            if (const auto error = refusal(document(fault.body, version))) tried += error->cure() + "\n";
    const std::vector<Refusal> refusals = refusals_in(std::string(TREEFARM_SOURCE_DIR) + "/coordinator/input/mitsuba");
    EXPECT_GT(refusals.size(), 100u);
    std::size_t mechanical = 0;
    for (const Refusal& found : refusals)
        for (const std::string& cure : found.cures) {
            if (!is_mechanical(cure)) continue;
            ++mechanical;
            EXPECT_NE(tried.find(cure), std::string::npos) << found.where << ": " << cure;
        }
    EXPECT_GT(mechanical, 40u);
}

}  // namespace
}  // namespace treefarm
