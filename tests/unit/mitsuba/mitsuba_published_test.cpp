// SPDX-License-Identifier: Apache-2.0
#include "common/config/job_reader.h"
#include "tests/support/mitsuba_fixture.h"

namespace treefarm {
namespace {

using namespace treefarm::test;

/// Contents of scenes that others published: loose ends, folders of their own, names of other programs' making.
class MitsubaPublished : public MitsubaFixture {
  protected:
    static constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    static std::string obj(const std::string& name) {
        return "<shape type=\"obj\"><string name=\"filename\" value=\"" + name + "\"/></shape>";
    }

    static bool warns_of(const LoadedScene& loaded, const std::string& words) {
        for (const Warning& warning : loaded.warnings)
            if (warning.text().find(words) != std::string::npos) return true;
        return false;
    }
};

TEST_F(MitsubaPublished, PathsNameFoldersOfFiles) {
    std::filesystem::create_directories(folder_ / "meshes");
    write("meshes/a.obj", kTriangle);
    EXPECT_NE(refusal(obj("a.obj"), "3.0.0"), "");
    EXPECT_EQ(mesh_of(load_with_sensor("<path value=\"meshes\"/>" + obj("a.obj"), "3.0.0")).triangle_count(), 1u);
    EXPECT_EQ(mesh_of(load_with_sensor(obj("a.obj") + "<path value=\"meshes\"/>", "3.0.0")).triangle_count(), 1u)
        << "a path holds for what stands before it, too";
    // It comes before the scene's own folder.
    write("a.obj", std::string(kTriangle) + "f 3 2 1\n");
    EXPECT_EQ(mesh_of(load_with_sensor("<path value=\"meshes\"/>" + obj("a.obj"), "3.0.0")).triangle_count(), 1u);
    EXPECT_EQ(mesh_of(load_with_sensor(obj("a.obj"), "3.0.0")).triangle_count(), 2u);
    EXPECT_NE(refusal("<path value=\"nowhere\"/>", "3.0.0").find("no folder"), std::string::npos);
    EXPECT_NE(refusal("<shape type=\"cube\"><path value=\"meshes\"/></shape>", "3.0.0"), "");
}

TEST_F(MitsubaPublished, IncludedFilesNameFilesOfTheSceneOrTheirOwn) {
    write("sub/part.xml", "<scene version=\"0.6.0\">" + obj("a.obj") + "</scene>");
    const std::string body = "<include filename=\"sub/part.xml\"/>";
    write("sub/a.obj", kTriangle);
    EXPECT_EQ(mesh_of(load_with_sensor(body)).triangle_count(), 1u);
    write("a.obj", std::string(kTriangle) + "f 3 2 1\n");
    EXPECT_EQ(mesh_of(load_with_sensor(body)).triangle_count(), 2u) << "the scene's folder comes first, as in Mitsuba";
}

TEST_F(MitsubaPublished, NamesFromSystemsThatIgnoreCase) {
    write("sub/Chair.OBJ", kTriangle);
    EXPECT_EQ(mesh_of(load_with_sensor(obj("Sub\\chair.obj"))).triangle_count(), 1u);
    const std::string missing = "a-folder-with-a-long-name/another-folder-with-a-long-name/a-mesh-with-a-long-name.obj";
    EXPECT_NE(refusal(obj(missing)).find(missing), std::string::npos) << "names of files are not cut";
}

TEST_F(MitsubaPublished, FlatMeshesAreLeftOut) {
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const auto loaded = load_with_sensor(obj("flat.obj") + "<shape type=\"cube\"/>");
    EXPECT_EQ(loaded.scene.shapes.size(), 1u);
    EXPECT_TRUE(warns_of(loaded, "no triangle of the shape has an area"));
}

TEST_F(MitsubaPublished, OtherIntegratorsOfTheSameImage) {
    const auto read = [&](const std::string& integrator) {
        const auto loaded = load_with_sensor(integrator, "3.0.0");
        EXPECT_TRUE(warns_of(loaded, "integrator")) << integrator;
        Job job;
        apply_layer(job, loaded.settings);
        return job;
    };
    const Job job = read(
        "<integrator type=\"mlt\"><integer name=\"maxDepth\" value=\"9\"/>"
        "<boolean name=\"twoStage\" value=\"true\"/></integrator>");
    EXPECT_EQ(job.integrator.max_depth, 9);
    EXPECT_EQ(job.guiding.type, Job().guiding.type) << "how to trace is the job's business";
    EXPECT_EQ(read("<integrator type=\"vpl\"/>").integrator.max_depth, 5);
    EXPECT_EQ(read("<integrator type=\"prb\"/>").integrator.max_depth, 6);
    const Job inner = read(
        "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/><integrator "
        "type=\"path\"><integer name=\"max_depth\" value=\"3\"/></integrator></integrator>");
    EXPECT_EQ(inner.integrator.max_depth, 3);
    EXPECT_EQ(inner.guiding.type, Job().guiding.type);
    EXPECT_EQ(refusal("<integrator type=\"aov\"/>"), "") << "Mitsuba shows layers alone; here they are beside an image";
    EXPECT_NE(refusal("<integrator type=\"guidedpath\"/>").find("did you mean \"guided_path\""), std::string::npos);
}

TEST_F(MitsubaPublished, PropertiesWithoutInfluence) {
    const std::string film =
        "<film type=\"hdrfilm\"><integer name=\"width\" value=\"30\"/>"
        "<integer name=\"height\" value=\"20\"/><float name=\"gamma\" value=\"2.2\"/>";
    const auto crop = [&](int width) {
        return "<sensor type=\"perspective\">" + film + "<integer name=\"cropWidth\" value=\"" + std::to_string(width) +
               "\"/><integer name=\"cropOffsetX\" value=\"0\"/></film></sensor>";
    };
    EXPECT_EQ(load(crop(30)).scene.film.width, 30) << "the window is the whole film";
    EXPECT_THROW(load(crop(31)), InputError);
    EXPECT_EQ(refusal("<integer name=\"kdMaxDepth\" value=\"3\"/>"), "");
    EXPECT_EQ(
        refusal("<integrator type=\"path\"><integer name=\"samples_per_pass\" value=\"3\"/></integrator>", "3.0.0"),
        "");
    EXPECT_NE(refusal("<shape type=\"cube\"><boolean name=\"flipNormals\" value=\"perhaps\"/></shape>"), "");
    EXPECT_EQ(refusal("<shape type=\"cube\"><boolean name=\"flipNormals\" value=\"True\"/></shape>"), "");
}

TEST_F(MitsubaPublished, WhatIsReferredToCanStandInTheScene) {
    const auto loaded = load(
        "<emitter type=\"area\" id=\"lamp\"/><sampler type=\"independent\" id=\"s\"><integer name=\"sample_count\" "
        "value=\"7\"/></sampler><sensor type=\"perspective\"><ref id=\"s\"/></sensor>"
        "<shape type=\"cube\"><ref id=\"lamp\"/></shape>",
        "3.0.0");
    EXPECT_EQ(loaded.scene.emitters.size(), 1u);
    Job job;
    apply_layer(job, loaded.settings);
    EXPECT_EQ(job.budget.spp, 7u);
    EXPECT_NE(refusal("<emitter type=\"area\"/>").find("belongs to no shape"), std::string::npos);
}

TEST_F(MitsubaPublished, MergedShapes) {
    const auto loaded = load_with_sensor(
        "<shape type=\"merge\"><shape type=\"cube\"/><shape type=\"rectangle\"><emitter type=\"area\"/></shape>"
        "</shape>",
        "3.0.0");
    EXPECT_EQ(loaded.scene.shapes.size(), 2u);
    EXPECT_EQ(loaded.scene.shapes[1].emitter, 0);
}

TEST_F(MitsubaPublished, BoardsOfNumbersAreExchangedInVersion3) {
    const auto board = [&](const std::string& slot, const std::string& version) {
        const std::string bsdf = slot == "alpha" ? "roughconductor" : "diffuse";
        const auto loaded =
            load_with_sensor("<shape type=\"cube\"><bsdf type=\"" + bsdf + "\"><texture name=\"" + slot +
                                 "\" type=\"checkerboard\"><float name=\"color0\" value=\"0.05\"/>"
                                 "<float name=\"color1\" value=\"0.3\"/></texture></bsdf></shape>",
                             version);
        return std::get<CheckerboardTexture>(loaded.scene.textures.at(0).kind).color0.x;
    };
    EXPECT_FLOAT_EQ(board("alpha", "0.6.0"), 0.05f);
    EXPECT_FLOAT_EQ(board("alpha", "3.0.0"), 0.3f);
    EXPECT_FLOAT_EQ(board("reflectance", "3.0.0"), 0.05f);
}

TEST_F(MitsubaPublished, MessagesNameTheNearestPluginAndWhatLenientDoes) {
    const std::string bsdf = refusal("<shape type=\"cube\"><bsdf type=\"difuse\"/></shape>");
    EXPECT_NE(bsdf.find("did you mean \"diffuse\""), std::string::npos) << bsdf;
    EXPECT_NE(bsdf.find("with --lenient it becomes diffuse"), std::string::npos) << bsdf;
    EXPECT_EQ(refusal("<shape type=\"cube\"><bsdf type=\"pplastic\"/></shape>").find("did you mean"), std::string::npos)
        << "a BSDF that is known is no misspelt one";
    EXPECT_NE(refusal("<shape type=\"spere\"/>").find("did you mean \"sphere\""), std::string::npos);
    EXPECT_NE(refusal("<emitter type=\"envmp\"/>").find("did you mean \"envmap\""), std::string::npos);
}

}  // namespace
}  // namespace treefarm
