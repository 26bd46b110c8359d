// SPDX-License-Identifier: Apache-2.0
// `treefarm check` as a user runs it: defects planted one per line, each found at its line.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/image/exr.h"
#include "tests/support/command.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

using nlohmann::json;

/// One line of a scene, and the finding that is to be at that line.
struct Defect {
    std::string line, kind, severity = "warning", says;
};

std::string rectangle(const std::string& inside, int z) {
    return "<shape type=\"rectangle\"><transform name=\"toWorld\"><translate z=\"-" + std::to_string(z) +
           "\"/></transform>" + inside + "</shape>";
}

std::string mesh(const std::string& file, const std::string& inside = "") {
    return "<shape type=\"" + file.substr(file.size() - 3) + "\"><string name=\"filename\" value=\"" + file + "\"/>" +
           inside + "</shape>";
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const std::string kLamp = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>";

std::string quoted(const std::string& path) {
    std::string text = "'";
    text += path;
    return text += "'";
}

class CheckCommand : public test::MitsubaFixture {
  protected:
    test::Ended run(const std::string& arguments) const { return test::run_treefarm("check " + arguments); }

    /// A scene of these lines below its first one, the sensor's.
    std::string scene_of(const std::vector<Defect>& defects, double camera = 5.0) const {
        std::string text =
            "<scene version=\"0.6.0\"><sensor type=\"perspective\"><transform name=\"toWorld\"><lookat "
            "origin=\"0,0," +
            std::to_string(camera) + "\" target=\"0,0,0\" up=\"0,1,0\"/></transform></sensor>\n";
        for (const Defect& defect : defects)
            text += defect.line + "\n";
        return write("planted.xml", text + "</scene>\n").string();
    }

    void expect_found(const std::vector<Defect>& defects, int code, double camera = 5.0) const {
        const std::string path = scene_of(defects, camera);
        const test::Ended found = run("--json '" + path + "'");
        EXPECT_EQ(found.code, code) << found.output;
        const json findings = json::parse(found.output).at("findings");
        const test::Ended lines = run("'" + path + "'");
        EXPECT_EQ(lines.code, code);
        for (std::size_t i = 0; i < defects.size(); ++i) {
            const Defect& defect = defects[i];
            if (defect.kind.empty()) continue;
            const int line = defect.line.empty() ? 0 : static_cast<int>(i) + 2;  // of the whole scene: its file
            const auto at = std::find_if(findings.begin(), findings.end(), [&](const json& f) {
                return f["kind"] == defect.kind && f["line"] == line && f["severity"] == defect.severity &&
                       f["what"].get<std::string>().find(defect.says) != std::string::npos;
            });
            EXPECT_NE(at, findings.end()) << defect.kind << " in line " << line << " of\n" << found.output;
            if (at == findings.end()) continue;
            EXPECT_EQ((*at)["file"], path);
            const std::string where = line > 0 ? path + ":" + std::to_string(line) + ":" : path + ": ";
            EXPECT_NE(lines.output.find(where), std::string::npos) << lines.output;
        }
        std::string counted;
        for (const std::string severity : {"error", "warning"}) {
            const auto count = std::count_if(findings.begin(), findings.end(),
                                             [&](const json& f) { return f["severity"] == severity; });
            if (count == 0) continue;
            counted += (counted.empty() ? "" : ", ") + std::to_string(count) + " " + severity + (count == 1 ? "" : "s");
        }
        if (counted.empty()) counted = "nothing risky";
        EXPECT_NE(lines.output.find(path + ": " + counted + "\n"), std::string::npos) << lines.output;
        for (const json& f : findings) {
            const auto line = static_cast<std::size_t>(f["line"].get<int>());
            EXPECT_TRUE(line == 0 || (line >= 2 && !defects.at(line - 2).kind.empty())) << "not planted: " << f;
        }
    }

    std::string ply(const std::string& name, const std::string& properties, const std::vector<std::string>& vertices,
                    const std::vector<std::string>& faces) const {
        std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices.size()) + "\n";
        for (const char property : properties)
            text +=
                std::string("property float ") + (property < 'x' ? "n" : "") +
                (property < 'x' ? std::string(1, static_cast<char>(property - 'a' + 'x')) : std::string(1, property)) +
                "\n";
        text +=
            "element face " + std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
        for (const std::vector<std::string>* lines : {&vertices, &faces})
            for (const std::string& line : *lines)
                text += line + "\n";
        write(name, text);
        return name;
    }

    /// Everything that can be planted in one line; a render refuses none of it.
    std::vector<Defect> risky() const {
        ply("flat.ply", "xyz", {"0 0 0", "1 0 0", "0.5 0 0", "0 1 0"}, {"3 0 1 2", "3 0 1 3"});
        ply("sliver.ply", "xyz", {"0 0 -7", "1 0 -7", "0.5 1e-8 -7"}, {"3 0 1 2"});
        ply("twice.ply", "xyz", {"0 0 -8", "1 0 -8", "0 1 -8"}, {"3 0 1 2", "3 1 2 0", "3 2 1 0"});
        ply("point.ply", "xyz", {"0 0 0", "0 0 0", "0 0 0"}, {"3 0 1 2"});
        ply("zeros.ply", "xyzabc", {"0 0 -9 0 0 0", "1 0 -9 0 0 1", "0 1 -9 1 0 0"}, {"3 0 1 2"});
        ply("sides.ply", "xyzabc", {"0 0 -10 0 0 1", "1 0 -10 0 0 -1", "0 1 -10 0 0 1"}, {"3 0 1 2"});
        ply("bent.ply", "xyz", {"0 0 -11", "1 0 -11", "0 1 -11", "1 1 -12"}, {"3 0 1 2", "3 1 3 2"});
        std::string facets;
        for (int i = 0; i < 100; ++i)
            facets += "v " + std::to_string(0.01 * i) + " 0 -13\nv " + std::to_string(0.01 * i) + " 1 -13.5\n";
        for (int i = 1; i < 199; ++i)
            facets += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
        write("facets.obj", facets);
        for (const auto& [name, value] : {std::pair("bright.exr", 3.0f), std::pair("infinite.exr", kInfinity)}) {
            Image image{1, 1, {}, {}};
            image.add_channel("Y")[0] = value;
            write_exr(folder_ / name, image);
        }
        const auto rough = [](const char* alpha) {
            return std::string("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"") + alpha + "\"/></bsdf>";
        };
        const auto glass = [](const char* index) {
            return std::string("<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"") + index +
                   "\"/><float name=\"extIOR\" value=\"1\"/></bsdf>";
        };
        return {
            {mesh("flat.ply"), "degenerate triangles", "warning", "1 triangle without area"},
            {mesh("point.ply"), "degenerate triangles", "warning", "no triangle of the shape has an area"},
            {mesh("sliver.ply"), "slivers", "note", ""},
            {mesh("twice.ply"), "duplicate triangles", "warning", "2 triangles that coincide with others of its own"},
            {rectangle("", 20), "", "", ""},
            {rectangle("", 20), "duplicate triangles", "warning", "2 triangles that coincide with others of the shape"},
            {mesh("zeros.ply"), "missing normals", "note", "1 of 3 vertices of the mesh have no normal"},
            {mesh("bent.ply"), "missing normals", "note", "4 of 4 vertices of the mesh have no normal"},
            {mesh("facets.obj", "<boolean name=\"faceNormals\" value=\"true\"/>"), "missing normals", "note",
             "its 198 triangles show as facets"},
            {mesh("sides.ply"), "normals disagree", "note", ""},
            {rectangle(rough("0.00001"), 21), "extreme alpha", "warning", "below 1e-4"},
            {rectangle(rough("0.0005"), 22), "extreme alpha", "note", "0.0005"},
            {rectangle(rough("5"), 23), "extreme alpha", "warning", "of 5"},
            {rectangle(glass("9"), 24), "extreme ior", "warning", "of 9"},
            {rectangle(glass("1.00001"), 25), "extreme ior", "warning", "of 1"},
            {rectangle("<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
                       "value=\"bright.exr\"/></texture></bsdf>",
                       26),
             "energy gain", "warning", "up to 3"},
            {rectangle("<bsdf type=\"mask\"><texture type=\"bitmap\" name=\"opacity\"><string name=\"filename\" "
                       "value=\"infinite.exr\"/></texture><bsdf type=\"diffuse\"/></bsdf>",
                       27),
             "numbers", "warning", "not finite"},
            {mesh("point.ply", kLamp), "zero-area emitter", "warning", ""},
            {"<shape type=\"rectangle\"><transform name=\"toWorld\"><translate z=\"200\"/></transform>" + kLamp +
                 "</shape>",
             "unreachable emitter", "warning", "there is nothing, not even the camera"},
            {"<integrator type=\"mlt\"/>", "reader", "warning", ""},
            {"<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0\"/></emitter>", "black emitter", "warning",
             ""},
            {"<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"0.00001\"/></transform></shape>",
             "tiny shape", "note", ""},
            {rectangle("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1.5\"/></bsdf>", 28), "reader",
             "warning", "a reflectance of 1.5 was scaled down to 0.99"},
        };
    }

    /// Defects that a render refuses, each for itself.
    std::vector<Defect> refused() const {
        ply("nan.ply", "xyz", {"0 0 0", "nan 0 0", "0 1 0"}, {"3 0 1 2"});
        write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 inf\nf 1//1 2//1 3//1\n");
        write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
        return {
            {rectangle("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"-1.5\"/></bsdf>", 1), "refused",
             "error", "a reflectance of -1.5"},
            {rectangle("<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><rgb name=\"specularReflectance\" "
                       "value=\"-2\"/></bsdf></bsdf>",
                       2),
             "refused", "error", "a reflectance of -2"},
            {rectangle("<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"1e9\"/></bsdf>", 3), "refused",
             "error", "an index of refraction"},
            {rectangle("<bsdf type=\"conductor\"><rgb name=\"eta\" value=\"1e9\"/><rgb name=\"k\" value=\"1\"/></bsdf>",
                       4),
             "extreme ior", "error", "an index of refraction"},
            {rectangle("<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"-1\"/></bsdf>", 5), "refused",
             "error", "a roughness of -1"},
            {rectangle("<emitter type=\"area\"><rgb name=\"radiance\" value=\"-1\"/></emitter>", 6), "refused", "error",
             "a radiance of -1"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/>" + kLamp + "</shape>", "refused", "error",
             "\"radius\" is not above 0"},
            {"<shape type=\"disk\"><transform name=\"toWorld\"><scale x=\"0\"/></transform>" + kLamp + "</shape>",
             "refused", "error", "it flattens space"},
            {"<emitter type=\"point\"><rgb name=\"intensity\" value=\"nan\"/></emitter>", "refused", "error",
             "is not a number"},
            {rectangle("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.00001\"/></bsdf>", 7),
             "extreme alpha", "warning", ""},
        };
    }
};

/// A room that stands a thousand of its sizes from the middle of its scene, and the scene's own remedy.
TEST_F(CheckCommand, SaysWhatADistantPositionCosts) {
    const std::string translation = "<translate x=\"1000.3\" y=\"700.21\" z=\"400.12\"/></transform>";
    const std::string scene =
        "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"1000.3,700.21,400.32\" "
        "target=\"1000.6,700.41,400.12\" up=\"0,1,0\"/></transform></sensor>\n"
        "<shape type=\"cube\"><transform name=\"to_world\">" +
        translation + "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>" +
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3000\"/></transform></shape>"
        "<emitter type=\"constant\"/></scene>\n";
    const std::string robust = "<boolean name=\"embree_use_robust_intersections\" value=\"true\"/>";
    const std::string start = "<scene version=\"3.0.0\">";
    const auto check = [&](const std::string& head) { return run(quoted(write("far.xml", head + scene).string())); };
    const test::Ended found = check(start), cured = check(start + robust);
    EXPECT_EQ(found.code, 5) << found.output;
    EXPECT_NE(found.output.find("pass its walls; set farm.robust = true"), std::string::npos) << found.output;
    EXPECT_EQ(cured.output.find("pass its walls"), std::string::npos) << cured.output;
}

TEST_F(CheckCommand, FindsEveryPlantedDefectAtItsLine) {
    expect_found(risky(), 5);
}

/// One refusal does not hide the next, nor what else is risky.
TEST_F(CheckCommand, FindsEverythingThatARenderRefuses) {
    expect_found(refused(), 2);
}

/// In a mesh file the place is the file's, and every file is looked at.
TEST_F(CheckCommand, FindsDefectsOfSeveralFiles) {
    refused();
    const std::string path = scene_of({{mesh("nan.ply"), "", "", ""},
                                       {mesh("nan.obj"), "", "", ""},
                                       {mesh("missing.obj"), "", "", ""},
                                       {mesh("index.obj"), "", "", ""}});
    const test::Ended found = run("--json '" + path + "'");
    EXPECT_EQ(found.code, 2);
    std::string found_at;
    const json findings = json::parse(found.output).at("findings");
    for (const json& f : findings)
        if (f["severity"] == "error")
            found_at += std::filesystem::path(f["file"].get<std::string>()).filename().string() + ":" +
                        std::to_string(f["line"].get<int>()) + " ";
    EXPECT_EQ(found_at, "nan.ply:11 nan.obj:4 planted.xml:4 index.obj:4 ") << found.output;
}

/// Findings on the whole scene have the scene's file for a place.
TEST_F(CheckCommand, FindsScaleAndPosition) {
    const auto room = [](const char* transform) {
        return std::string("<shape type=\"cube\"><transform name=\"toWorld\">") + transform +
               "</transform></shape><emitter type=\"constant\"/>";
    };
    const auto whole = [](const char* kind, const char* severity) { return Defect{"", kind, severity, ""}; };
    expect_found({{room("<translate x=\"3e6\"/>"), "", "", ""}, whole("far from origin", "warning")}, 5);
    expect_found({{room("<scale value=\"1e-5\"/>"), "", "", ""}, whole("scale", "note")}, 0, 1e-4);
    expect_found({{room("<scale value=\"1e7\"/>"), "", "", ""}, whole("scale", "note")}, 0, 5e7);
    expect_found({{room("<scale value=\"1\"/>"), "", "", ""}, whole("distant camera", "warning")}, 5, 1e6);
    expect_found({{"<emitter type=\"constant\"/>", "", "", ""}, whole("no shapes", "warning")}, 5);
    // Scenes of 0.6 without an emitter get sun and sky.
    const auto dark = write("dark.xml", "<scene version=\"3.0.0\"><sensor type=\"perspective\"/></scene>");
    EXPECT_NE(run(quoted(dark.string())).output.find("the scene has no emitters"), std::string::npos);
}

TEST_F(CheckCommand, SpotsThatHitNothing) {
    expect_found({{rectangle("", 1), "", "", ""},
                  {"<emitter type=\"spot\"><transform name=\"toWorld\"><lookat origin=\"0,0,3\" target=\"0,0,9\" "
                   "up=\"0,1,0\"/></transform></emitter>",
                   "unreachable emitter", "warning", "the spot's cone meets nothing"}},
                 5);
}

TEST_F(CheckCommand, SoundScenesAndUnreadableOnes) {
    const auto [code, text] = run(quoted(test::own_scene("cornell-box.xml")));
    EXPECT_EQ(code, 0) << text;
    EXPECT_NE(text.find("nothing risky"), std::string::npos) << text;
    const std::string path = write("broken.xml", "<scene version=\"0.6.0\"><shape type=\"sphere\"/>").string();
    const auto [bad, message] = run("'" + path + "'");
    EXPECT_EQ(bad, 2);
    EXPECT_NE(message.find("broken.xml:1:"), std::string::npos) << message;
    // A program that asked for JSON gets it.
    const auto [bad_too, json_text] = run("--json '" + path + "'");
    EXPECT_EQ(bad_too, 2);
    const json finding = json::parse(json_text)["findings"][0];
    EXPECT_EQ(finding["severity"], "error");
    EXPECT_EQ(finding["file"], path);
    EXPECT_EQ(finding["line"], 1);
}

}  // namespace
}  // namespace treefarm
