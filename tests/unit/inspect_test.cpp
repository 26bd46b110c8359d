// What `treefarm check` finds: every kind of defect planted, and none where there is none.
#include "common/scene/inspect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "common/image/exr.h"
#include "common/scene/load.h"
#include "tests/support/mitsuba_fixture.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

std::set<std::string> kinds_of(const std::vector<Finding>& findings) {
    std::set<std::string> kinds;
    for (const Finding& finding : findings)
        kinds.insert(finding.kind);
    return kinds;
}

const Finding* find(const std::vector<Finding>& findings, const std::string& kind) {
    const auto at = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.kind == kind; });
    return at == findings.end() ? nullptr : &*at;
}

TEST(Inspect, FindsNothingInASoundScene) {
    const std::vector<Finding> findings = inspect(test::cornell_box(1.0f, Vec3(0.0f)));
    EXPECT_TRUE(findings.empty()) << findings[0].text();
}

TEST(Inspect, OwnScenesHaveNoErrors) {
    for (const char* name : {"cornell-box", "glossy-room", "mixed-room", "diffuse-room", "caustic", "door-ajar",
                             "white-furnace", "features"})
        for (const Finding& f : inspect(load_scene_unchecked(test::own_scene(std::string(name) + ".xml")).scene))
            EXPECT_NE(f.severity, Finding::Severity::error) << f.text();
}

TEST(Inspect, NumbersThatAreNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int what = 0; what < 4; ++what) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        auto& mesh = std::get<Mesh>(scene.shapes[2].geometry);
        scene.shapes[2].where = {"a.xml", 7, 3};
        if (what == 0) mesh.positions[1].y = nan;
        if (what == 1) mesh.normals.assign(mesh.positions.size(), Vec3(0, 0, nan));
        if (what == 2) mesh.uvs.assign(mesh.positions.size(), Vec2(nan, 0));
        if (what == 3) mesh.indices[0] = 1000;
        const std::vector<Finding> findings = inspect(scene);
        ASSERT_FALSE(findings.empty()) << what;
        EXPECT_EQ(findings[0].kind, what == 3 ? "bad indices" : "numbers");
        EXPECT_EQ(findings[0].severity, Finding::Severity::error);
        EXPECT_NE(findings[0].text().find("a.xml:7:3: error: "), std::string::npos) << findings[0].text();
    }
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    std::get<AreaEmitter>(scene.emitters[0].kind).radiance.value.x = nan;
    EXPECT_TRUE(find(inspect(scene), "numbers"));
}

TEST(Inspect, ScaleAndPlace) {
    const auto kinds = [](float scale, const Vec3& offset) {
        return kinds_of(inspect(test::cornell_box(scale, offset)));
    };
    EXPECT_TRUE(kinds(1e-5f, Vec3(0.0f)).contains("scale"));
    EXPECT_TRUE(kinds(1e8f, Vec3(0.0f)).contains("scale"));
    EXPECT_TRUE(kinds(1.0f, Vec3(1e5f)).contains("far from origin"));
    EXPECT_TRUE(kinds(100.0f, Vec3(1e3f)).empty());
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    scene.camera.origin = Vec3(0, 0, -1e6f);
    EXPECT_TRUE(find(inspect(scene), "distant camera"));
}

TEST(Inspect, EmittersAreReachableFromTheirFront) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    // Turned to the ceiling, which is above it: reached. Above the ceiling, facing up: not.
    auto& lamp = std::get<Mesh>(scene.shapes.back().geometry);
    std::swap(lamp.indices[1], lamp.indices[2]);
    std::swap(lamp.indices[4], lamp.indices[5]);
    EXPECT_FALSE(find(inspect(scene), "unreachable emitter"));
    for (Vec3& p : lamp.positions)
        p.y = 1.5f;
    const std::vector<Finding> findings = inspect(scene);
    EXPECT_TRUE(find(findings, "unreachable emitter"));
}

/// The planted scene, its defects named as findings name them.
class CheckCommand : public test::MitsubaFixture {
  protected:
    std::pair<int, std::string> run(const std::string& arguments) const {
        std::string output;
        FILE* pipe = popen(("'" TREEFARM_PROGRAM "' check " + arguments + " 2>&1").c_str(), "r");
        std::array<char, 4096> buffer;
        while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe))
            output.append(buffer.data(), size);
        const int status = pclose(pipe);
        return {WEXITSTATUS(status), output};
    }

    std::string planted() const {
        std::string obj =
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0 1e-9 1\nvn 0 0 0\nf 1//1 2//1 3//1\nf 2//1 3//1 1//1\n"
            "f 1//1 2//1 4//1\n";
        write("broken.obj", obj);
        std::string facets;
        for (int i = 0; i < 100; ++i)
            facets += "v " + std::to_string(i) + " 0 " + std::to_string(i % 3) + "\nv " + std::to_string(i) + " 1 0\n";
        for (int i = 1; i < 199; ++i)
            facets += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
        write("facets.obj", facets);
        Image image{1, 1, {}, {}};
        image.add_channel("Y")[0] = 3.0f;
        write_exr(folder_ / "bright.exr", image);
        return R"(<sensor type="perspective"><transform name="toWorld"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></sensor>
<shape type="obj"><string name="filename" value="broken.obj"/></shape>
<shape type="obj"><string name="filename" value="facets.obj"/><boolean name="faceNormals" value="true"/></shape>
<shape type="rectangle"><bsdf type="roughconductor"><float name="alpha" value="0.00001"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><translate z="0.5"/></transform><bsdf type="dielectric"><float name="intIOR" value="9"/><float name="extIOR" value="1"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><translate z="1"/></transform><bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value="bright.exr"/></texture></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><translate z="2"/></transform></shape>
<shape type="rectangle"><transform name="toWorld"><translate z="2"/></transform></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="0.00001"/></transform></shape>
<shape type="rectangle"><transform name="toWorld"><translate z="200"/></transform><emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
<shape type="sphere"><emitter type="area"><rgb name="radiance" value="0"/></emitter></shape>
)";
    }
};

TEST_F(CheckCommand, FindsEveryPlantedDefect) {
    const auto path = write("planted.xml", "<scene version=\"0.6.0\">\n" + planted() + "</scene>\n");
    const auto [code, text] = run("--json '" + path.string() + "'");
    EXPECT_EQ(code, 5);
    const nlohmann::json json = nlohmann::json::parse(text);
    std::set<std::string> kinds;
    for (const auto& finding : json["findings"]) {
        kinds.insert(finding["kind"]);
        if (finding["kind"] != "scale") {
            EXPECT_GT(finding["line"].get<int>(), 0) << finding;
        }
    }
    for (const char* kind : {"degenerate triangles", "duplicate triangles", "missing normals", "extreme alpha",
                             "extreme ior", "energy gain", "unreachable emitter", "black emitter", "tiny shape"})
        EXPECT_TRUE(kinds.contains(kind)) << kind << "\n" << text;
    const auto [lines_code, lines] = run("'" + path.string() + "'");
    EXPECT_EQ(lines_code, 5);
    EXPECT_NE(lines.find("planted.xml:3:"), std::string::npos) << lines;
}

TEST_F(CheckCommand, SoundScenesAndUnreadableOnes) {
    const auto [code, text] = run("'" + test::own_scene("cornell-box.xml") + "'");
    EXPECT_EQ(code, 0) << text;
    EXPECT_NE(text.find("nothing risky"), std::string::npos) << text;
    const auto path = write("broken.xml", "<scene version=\"0.6.0\"><shape type=\"sphere\"/>");
    const auto [bad, message] = run("'" + path.string() + "'");
    EXPECT_EQ(bad, 2);
    EXPECT_NE(message.find("broken.xml:1:"), std::string::npos) << message;
    // What the reader itself refuses is one line, as in a render.
    const auto gain = write("gain.xml",
                            "<scene version=\"0.6.0\"><sensor type=\"perspective\"/>\n<shape type=\"sphere\"><bsdf "
                            "type=\"diffuse\"><rgb name=\"reflectance\" value=\"1.5\"/></bsdf></shape></scene>");
    const auto [refused, line] = run("'" + gain.string() + "'");
    EXPECT_EQ(refused, 2);
    EXPECT_NE(line.find("gain.xml:2:"), std::string::npos) << line;
}

}  // namespace
}  // namespace treefarm
