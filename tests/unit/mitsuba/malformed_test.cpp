// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "common/config/job_reader.h"
#include "coordinator/input/load.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

/// "c7.xml".
std::string numbered(const char* stem, int number) {
    std::string name = stem;
    name += std::to_string(number);
    return name += ".xml";
}

std::string include_of(const std::string& file) {
    std::string element = "<include filename=\"";
    element += file;
    return element += "\"/>";
}

/// Bad input gives one clear line that begins with its place.
class Malformed : public test::FolderTest {
  protected:
    /// The message about a file, without the folder's name.
    std::string message_of_file(const std::string& name) const {
        try {
            const LoadedScene loaded = load_scene(folder_ / name);
            Job job;
            apply_layer(job, loaded.settings);
        } catch (const InputError& error) {
            std::string message = error.what();
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            const std::string folder = folder_.string() + "/";
            for (std::size_t at; (at = message.find(folder)) != std::string::npos;)
                message.erase(at, folder.size());
            return message;
        }
        return "no error";
    }

    /// The message about a scene, whose second line has a sensor and whose third is `line`; a BSDF is that of a shape.
    std::string message_of(const std::string& line) const {
        const bool is_bsdf = line.starts_with("<bsdf");
        write("s.xml", std::string("<scene version=\"0.6.0\">\n<sensor type=\"perspective\"/>") +
                           (is_bsdf ? "<shape type=\"cube\">\n" : "\n") + line + "\n" + (is_bsdf ? "</shape>" : "") +
                           "</scene>\n");
        return message_of_file("s.xml");
    }

    /// The message about a scene with this line inside its sensor.
    std::string message_of_sensor(const std::string& line) const {
        write("s.xml", "<scene version=\"0.6.0\">\n<sensor type=\"perspective\">\n" + line + "\n</sensor></scene>\n");
        return message_of_file("s.xml");
    }

    void expect(const std::string& line, const std::string& message) const {
        EXPECT_EQ(message_of(line).substr(0, message.size()), message) << line << "\n -> " << message_of(line);
    }
};

TEST_F(Malformed, Files) {
    EXPECT_EQ(message_of_file("none.xml"), "there is no file \"none.xml\"; check the path");
    write("scene.pbrt", "");
    EXPECT_EQ(message_of_file("scene.pbrt"),
              "scene.pbrt: scenes of kind \".pbrt\" cannot be read; look for a Mitsuba version of it, or bring it into "
              "Blender and export it as a Mitsuba scene (.xml) with the add-on mitsuba-blender");
    std::filesystem::create_directories(folder_ / "folder.xml");
    EXPECT_EQ(message_of_file("folder.xml"), "\"folder.xml\" is not a file; check the path");
    write("empty.xml", "");
    EXPECT_EQ(message_of_file("empty.xml").substr(0, 10), "empty.xml:");
    write("text.xml", "this is no XML");
    EXPECT_EQ(message_of_file("text.xml").substr(0, 9), "text.xml:");
    write("cut.xml", "<scene version=\"0.6.0\">\n  <sensor type=\"perspective\"\n");
    EXPECT_EQ(message_of_file("cut.xml").substr(0, 10), "cut.xml:2:");
    write("tags.xml", "<scene version=\"0.6.0\">\n<a>\n</b>\n</scene>");
    EXPECT_EQ(message_of_file("tags.xml").substr(0, 11), "tags.xml:3:");
    write("two.xml", "<scene version=\"0.6.0\"/>\n<scene version=\"0.6.0\"/>");
    EXPECT_EQ(message_of_file("two.xml").substr(0, 12), "two.xml:2:1:");
    write("job.xml", "<job/>");
    EXPECT_EQ(message_of_file("job.xml").substr(0, 12), "job.xml:1:1:");
}

TEST_F(Malformed, EveryCutOfASceneIsRefused) {
    const std::string whole =
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"/></sensor>"
        "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"2\"/></transform></shape></scene>";
    write("s.xml", whole);
    ASSERT_EQ(message_of_file("s.xml"), "no error");
    for (std::size_t n = 0; n < whole.size(); ++n) {
        write("s.xml", whole.substr(0, n));
        EXPECT_NE(message_of_file("s.xml"), "no error") << n;
    }
}

TEST_F(Malformed, Versions) {
    for (const char* version : {"", "x", "4.0.0", "1.0", "-1"}) {
        write("s.xml", "<scene version=\"" + std::string(version) + "\"><sensor type=\"perspective\"/></scene>");
        EXPECT_EQ(message_of_file("s.xml").substr(0, 10), "s.xml:1:1:") << version;
    }
    write("s.xml", "<scene><sensor type=\"perspective\"/></scene>");
    EXPECT_EQ(message_of_file("s.xml"), "s.xml:1:1: <scene> has no attribute \"version\"; add it");
}

TEST_F(Malformed, Structure) {
    write("s.xml", "<scene version=\"3.0.0\">\n</scene>");
    EXPECT_EQ(message_of_file("s.xml").find("s.xml:1:1: the scene has no sensor; add <sensor type=\"perspective\">"),
              0u);
    expect("<mystery/>", "s.xml:3:1: unknown element <mystery> in <scene>");
    expect("<emiter type=\"constant\"/>",
           "s.xml:3:1: unknown element <emiter> in <scene>; did you mean \"emitter\"? Otherwise remove it");
    expect("<shape/>", "s.xml:3:1: <shape> has no attribute \"type\"");
    expect("<shape type=\"cube\" colour=\"red\"/>", "s.xml:3:1: <shape> has the unknown attribute \"colour\"");
    expect("<shape type=\"sphere\"><float name=\"radius\" vale=\"2\"/></shape>",
           "s.xml:3:22: <float> has the unknown attribute \"vale\"; did you mean \"value\"? Otherwise remove it");
    expect("<shape type=\"cube\" type=\"cube\"/>", "s.xml:3:1: ");
    expect("<shape type=\"cube\">words</shape>", "s.xml:3:20: text \"words\" stands between elements");
    expect("<shape type=\"cube\"><boolean name=\"flipNormals\" value=\"1\"/></shape>",
           "s.xml:3:20: \"1\" is neither true nor false");
    expect("<shape type=\"cube\"><float name=\"flipNormals\" value=\"1\"/></shape>",
           "s.xml:3:20: \"flipNormals\" of <shape type=\"cube\"> is a <float>");
    expect("<shape type=\"torus\"/>",
           "s.xml:3:1: the shape \"torus\" is not available in this version; use obj, ply, serialized, rectangle");
    std::string wide = "<shape";
    for (int i = 0; i < 300; ++i)
        wide += " a" + std::to_string(i) + "=\"\"";
    expect(wide + "/>", "s.xml:3:1: <shape> has more than 100 attributes");
    std::string deep;
    for (int i = 0; i < 5000; ++i)
        deep += "<bsdf type=\"twosided\">";
    EXPECT_NE(message_of(deep).find("s.xml:"), std::string::npos);
    for (int i = 0; i < 5000; ++i)
        deep += "</bsdf>";
    EXPECT_NE(message_of(deep).find("nested more than 100 deep"), std::string::npos);
}

TEST_F(Malformed, References) {
    expect("<shape type=\"cube\"><ref id=\"wite\"/></shape><bsdf type=\"diffuse\" id=\"white\"/>",
           "s.xml:3:20: nothing in the scene has the id \"wite\"; did you mean \"white\"?");
    expect("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>", "s.xml:3:1: <bsdf> refers to itself");
    expect(
        "<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref "
        "id=\"a\"/></bsdf>",
        "s.xml:3:1: <bsdf> refers to itself, directly or through others");
    expect("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>",
           "s.xml:3:30: the id \"a\" is taken since s.xml:3:1");
    expect("<alias id=\"a\" as=\"b\"/>", "s.xml:3:1: nothing in the scene has the id \"a\"");
    std::string chain;
    for (int i = 0; i < 3000; ++i)
        chain += "<bsdf type=\"twosided\" id=\"" + std::to_string(i) + "\"><ref id=\"" + std::to_string(i + 1) +
                 "\"/></bsdf>";
    EXPECT_NE(message_of(chain + "<bsdf type=\"diffuse\" id=\"3000\"/>").find("references are nested more than"),
              std::string::npos);
}

TEST_F(Malformed, Includes) {
    expect("<include filename=\"none.xml\"/>", "s.xml:3:1: there is no file \"none.xml\"");
    expect("<include filename=\"s.xml\"/>", "s.xml:3:1: \"s.xml\" includes itself");
    write("a.xml", "<scene version=\"0.6.0\">\n<include filename=\"b.xml\"/>\n</scene>");
    write("b.xml", "<scene version=\"0.6.0\">\n<include filename=\"./a.xml\"/>\n</scene>");
    expect("<include filename=\"a.xml\"/>", "b.xml:2:1: ");
    write("bad.xml", "<scene version=\"0.6.0\">\n\n   <shape type=\"torus\"/>\n</scene>");
    expect("<include filename=\"bad.xml\"/>", "bad.xml:3:4: the shape \"torus\"");
    write("broken.xml", "<scene version=\"0.6.0\">\n<shape");
    expect("<include filename=\"broken.xml\"/>", "broken.xml:2:");
    for (int i = 0; i < 20; ++i)
        write(numbered("c", i), "<scene version=\"0.6.0\">" + include_of(numbered("c", i + 1)) + "</scene>");
    EXPECT_NE(message_of("<include filename=\"c0.xml\"/>").find("includes are nested more than 15 deep"),
              std::string::npos);
    for (int i = 0; i < 10; ++i) {
        std::string fivefold;
        for (int k = 0; k < 5; ++k)
            fivefold += include_of(numbered("d", i + 1));
        write(numbered("d", i), "<scene version=\"0.6.0\">" + fivefold + "</scene>");
    }
    write("d10.xml", "<scene version=\"0.6.0\"/>");
    EXPECT_NE(message_of("<include filename=\"d0.xml\"/>").find("includes more than 10000 files"), std::string::npos);
}

TEST_F(Malformed, Parameters) {
    expect("<shape type=\"$kind\"/>", "s.xml:3:1: \"$kind\" uses a $name that has no value");
    std::string bomb = "<default name=\"a0\" value=\"0123456789\"/>";
    for (int i = 0; i < 30; ++i)
        bomb += "<default name=\"a" + std::to_string(i + 1) + "\" value=\"$a" + std::to_string(i) + "x$a" +
                std::to_string(i) + "\"/>";
    EXPECT_NE(message_of(bomb).find("more than 16 MiB"), std::string::npos);
    std::string many = bomb.substr(0, bomb.find("<default name=\"a20\""));
    for (int i = 0; i < 20; ++i)
        many += "<shape type=\"cube\" id=\"$a19\"/>";
    EXPECT_NE(message_of(many).find("more than 64 MiB"), std::string::npos) << message_of(many).substr(0, 200);
    try {
        message_of("");
        load_scene(folder_ / "s.xml", {{"typo", "1"}});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("does not use $typo"), std::string::npos);
    }
}

TEST_F(Malformed, Transforms) {
    const auto transform = [&](const std::string& steps) {
        return message_of("<shape type=\"cube\" id=\"box\"><transform name=\"toWorld\">" + steps +
                          "</transform></shape>");
    };
    EXPECT_EQ(transform("<scale x=\"0\"/>"),
              "s.xml:3:29: the transformation of <shape type=\"cube\"> \"box\" is singular: it flattens space; give no "
              "scale of 0");
    for (const char* steps : {"<scale value=\"0\"/>",
                              "<matrix value=\"1 2 3 0 2 4 6 0 0 0 1 0 0 0 0 1\"/>",
                              "<matrix value=\"1 2 3\"/>",
                              "<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>",
                              "<translate x=\"nan\"/>",
                              "<translate x=\"1e31\"/>",
                              "<translate x=\"one\"/>",
                              "<rotate angle=\"3\"/>",
                              "<rotate x=\"1\"/>",
                              "<rotate x=\"1\" angle=\"inf\"/>",
                              "<scale/>",
                              "<scale x=\"1\" value=\"2\"/>",
                              "<scale value=\"1 2\"/>",
                              "<scale q=\"1\"/>",
                              "<shear x=\"1\"/>",
                              "<lookat origin=\"0 0 0\" target=\"0 0 0\" up=\"0 1 0\"/>",
                              "<lookat origin=\"0 0 0\" target=\"0 1 0\" up=\"0 1 0\"/>",
                              "<lookat origin=\"0 0\" target=\"0 1 0\"/>",
                              "<lookat target=\"0 1 0\"/>",
                              "<scale value=\"1e20\"/><scale value=\"1e20\"/>"})
        EXPECT_EQ(transform(steps).substr(0, 8), "s.xml:3:") << steps << " -> " << transform(steps);
}

TEST_F(Malformed, ShapesAndColours) {
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>",
           "s.xml:3:22: \"radius\" is not above 0");
    expect("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\"/></shape>",
           "s.xml:3:22: <point> has no attribute \"z\"");
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"1e39\"/></shape>",
           "s.xml:3:1: the shape is not finite");
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"2e18\"/></shape>",
           "s.xml:3:1: the shape has a coordinate beyond 1e18");
    expect("<shape type=\"cube\"><transform name=\"toWorld\"><scale value=\"2e18\"/></transform></shape>",
           "s.xml:3:1: the shape has a coordinate beyond 1e18");
    expect("<shape type=\"obj\"/>", "s.xml:3:1: <shape type=\"obj\"> has no file name");
    expect("<shape type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></shape>",
           "s.xml:3:19: there is no file \"no.obj\"");
    write("nan.obj", "v 0 0 0\nv 1 nan 0\n");
    expect("<shape type=\"obj\"><string name=\"filename\" value=\"nan.obj\"/></shape>",
           "nan.obj:2:5: \"nan\" is not a number");
    write("index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    expect("<shape type=\"obj\"><string name=\"filename\" value=\"index.obj\"/></shape>",
           "index.obj:3:7: vertex 3 of 2");
    write("none.obj", "v 0 0 0\n");
    expect("<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>",
           "none.obj: the OBJ file has no faces");
    expect("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"-1.2\"/></bsdf>",
           "s.xml:3:22: a reflectance of -1.2; give values from 0 to 1");
    write("s3.xml",
          "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/><shape type=\"cube\">\n<bsdf type=\"diffuse\"><rgb "
          "name=\"reflectance\" value=\"1.2\"/></bsdf></shape></scene>");
    EXPECT_EQ(message_of_file("s3.xml"), "s3.xml:3:22: a reflectance of 1.2; give values from 0 to 1");
    expect("<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"/></bsdf>",
           "s.xml:3:22: <texture type=\"bitmap\"> has no file name");
    expect("<bsdf type=\"twosided\"/>", "s.xml:3:1: <bsdf type=\"twosided\"> has no BSDF inside");
    expect("<bsdf type=\"diffuse\"><blackbody name=\"reflectance\" temperature=\"5000\"/></bsdf>",
           "s.xml:3:22: <blackbody> is light");
    expect("<shape type=\"cube\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"-1\"/></emitter></shape>",
           "s.xml:3:41: a radiance of -1");
    expect("<shape type=\"cube\"><emitter type=\"spot\"/></shape>", "s.xml:3:20: <emitter type=\"spot\"> in a shape");
    expect("<emitter type=\"projector\"/>", "s.xml:3:1: <emitter type=\"projector\"> is not available");
    expect("<emitter type=\"constant\"/><emitter type=\"constant\"/>", "s.xml:3:27: this is a second environment");
}

TEST_F(Malformed, SensorsAndFilms) {
    const auto film = [&](const std::string& inside) {
        return message_of_sensor("<film type=\"hdrfilm\">" + inside + "</film>");
    };
    EXPECT_EQ(film("<integer name=\"width\" value=\"0\"/>"),
              "s.xml:3:22: the film's width is 0 pixels; give 1 to 65535");
    for (const char* inside :
         {"<integer name=\"height\" value=\"65536\"/>", "<integer name=\"height\" value=\"99999999999999999999\"/>",
          "<integer name=\"width\" value=\"1.5\"/>", "<float name=\"width\" value=\"1\"/>",
          "<integer name=\"cropWidth\" value=\"99999\"/>", "<rfilter type=\"sinc\"/>",
          "<rfilter type=\"box\"><float name=\"radius\" value=\"0\"/></rfilter>",
          "<rfilter type=\"box\"/><rfilter type=\"box\"/>"})
        EXPECT_EQ(film(inside).substr(0, 8), "s.xml:3:") << inside;
    for (const char* line : {"<float name=\"fov\" value=\"0\"/>", "<float name=\"fov\" value=\"180\"/>",
                             "<float name=\"fov\" value=\"nan\"/>", "<string name=\"focalLength\" value=\"long\"/>",
                             "<film type=\"mfilm\"/>", "<transform name=\"toWorld\"><scale value=\"2\"/></transform>",
                             "<sampler type=\"independent\"><integer name=\"sampleCount\" value=\"0\"/></sampler>",
                             "<sampler type=\"independent\"><integer name=\"seed\" value=\"-1\"/></sampler>",
                             "<float name=\"fov\" value=\"20\"/><string name=\"focalLength\" value=\"50mm\"/>",
                             "<float name=\"fov\" value=\"20\"/><string name=\"fovAxis\" value=\"z\"/>"})
        EXPECT_EQ(message_of_sensor(line).substr(0, 8), "s.xml:3:") << line << " -> " << message_of_sensor(line);
}

TEST_F(Malformed, Integrators) {
    for (const char* line :
         {"<integrator type=\"field\"/>",
          "<integrator type=\"direct\"><integer name=\"bsdfSamples\" value=\"-1\"/></integrator>",
          "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"0\"/></integrator>",
          "<integrator type=\"guided_path\"><float name=\"budget\" value=\"0\"/></integrator>",
          "<integrator type=\"guided_path\"><string name=\"budgetType\" value=\"hours\"/></integrator>",
          "<integrator type=\"guided_path\"><string name=\"budgetType\" value=\"spp\"/><float name=\"budget\" "
          "value=\"0.5\"/></integrator>"})
        EXPECT_EQ(message_of(line).substr(0, 8), "s.xml:3:") << line << " -> " << message_of(line);
    const auto guided = [&](const std::string& property) {
        return message_of("<integrator type=\"guided_path\"><string name=\"budgetType\" value=\"spp\"/>" + property +
                          "</integrator>");
    };
    EXPECT_EQ(guided(""), "no error");
    for (const char* property :
         {"<string name=\"nee\" value=\"sometimes\"/>", "<string name=\"spatialFilter\" value=\"gauss\"/>",
          "<string name=\"directionalFilter\" value=\"stochastic\"/>",
          "<string name=\"bsdfSamplingFractionLoss\" value=\"l2\"/>", "<float name=\"dTreeThreshold\" value=\"0\"/>",
          "<float name=\"bsdfSamplingFraction\" value=\"2\"/>", "<integer name=\"sTreeThreshold\" value=\"-3\"/>"})
        EXPECT_EQ(guided(property).substr(0, 8), "s.xml:3:") << property << " -> " << guided(property);
}

/// A repository's pointer in place of the file: of each kind of file, the message says so.
TEST_F(Malformed, PointersOfGitLfs) {
    const std::string pointer =
        "version https://git-lfs.github.com/spec/v1\noid sha256:"
        "4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
    for (const char* name : {"scene.xml", "mesh.obj", "mesh.ply", "mesh.serialized", "image.exr", "image.png"})
        write(name, pointer);
    EXPECT_NE(message_of_file("scene.xml").find("is a pointer of Git LFS"), std::string::npos);
    const auto of_shape = [&](const std::string& inside) {
        write("asks.xml", "<scene version=\"0.6.0\"><sensor type=\"perspective\"/>\n" + inside + "</scene>");
        return message_of_file("asks.xml");
    };
    for (const char* type : {"obj", "ply", "serialized"}) {
        const std::string message = of_shape("<shape type=\"" + std::string(type) +
                                             "\"><string name=\"filename\" value=\"mesh." + type + "\"/></shape>");
        EXPECT_NE(message.find("is a pointer of Git LFS"), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with("asks.xml:2:")) << message;
    }
    for (const char* file : {"image.exr", "image.png"}) {
        const std::string message = of_shape(
            "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
            "<string name=\"filename\" value=\"" +
            std::string(file) + "\"/></texture></bsdf></shape>");
        EXPECT_NE(message.find("is a pointer of Git LFS"), std::string::npos) << message;
        EXPECT_NE(message.find("git lfs pull"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace treefarm
