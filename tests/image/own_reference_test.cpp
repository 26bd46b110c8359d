// SPDX-License-Identifier: Apache-2.0
// Against long unguided renders of the scenes in configs/scenes, kept beside this file (make_references): what a later
// build changes shows in any clone.
#include <gtest/gtest.h>

#include "common/config/job_reader.h"
#include "common/image/exr.h"
#include "coordinator/input/load.h"
#include "tests/support/rendered.h"

namespace treefarm {
namespace {

struct Case {
    const char* scene;
    GuidingType guiding;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.scene;
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
    std::string name = info.param.scene;
    std::erase(name, '-');
    return name + (info.param.guiding == GuidingType::none  ? "None"
                   : info.param.guiding == GuidingType::ppg ? "Ppg"
                                                            : "View");
}

RgbImage layer_of(const Image& file, const std::string& prefix) {
    RgbImage layer(file.width, file.height);
    for (int c = 0; c < 3; ++c) {
        const std::string channel = prefix + "RGB"[c];
        const auto at = std::find(file.channel_names.begin(), file.channel_names.end(), channel);
        if (at == file.channel_names.end()) throw std::runtime_error("a reference has no channel " + channel);
        const auto values = file.channel(static_cast<std::size_t>(at - file.channel_names.begin()));
        for (std::size_t p = 0; p < values.size(); ++p)
            layer.pixels[p][c] = values[p];
    }
    return layer;
}

class OwnReference : public testing::TestWithParam<Case> {};

TEST_P(OwnReference, AgreesInTheZTests) {
    const std::string source = TREEFARM_SOURCE_DIR, scene = GetParam().scene;
    const Image file = read_exr(source + "/tests/image/references/" + scene + ".exr").image;
    const LoadedScene loaded =
        load_scene(source + "/configs/scenes/" + scene + ".xml", {}, false, file.width, file.height);
    Job job;
    apply_layer(job, loaded.settings);
    job.budget.spp = 252;
    job.sampler.seed = 12;
    job.integrator.next_event = NextEvent::always;
    job.guiding.type = GetParam().guiding;
    job.guiding.combination = Combination::fixed;
    const test::Rendered own = test::rendered(test::render_locally(loaded.scene, job), loaded.scene.film);
    const RgbImage reference = layer_of(file, ""), reference_variance = layer_of(file, "variance.");
    test::expect_z_tests_pass({own.mean, reference, &own.variance, &reference_variance});
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const char* scene :
         {"cornell-box", "diffuse-room", "features", "glossy-room", "matte-room", "mixed-room", "white-furnace"})
        for (const GuidingType guiding : {GuidingType::none, GuidingType::ppg, GuidingType::view})
            all.push_back({scene, guiding});
    return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnReference, testing::ValuesIn(cases()), name_of);

}  // namespace
}  // namespace treefarm
