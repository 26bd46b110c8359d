// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/config/estimators.h"
#include "tests/mpi/program.h"
#include "tests/support/guide_types.h"
#include "tests/support/support.h"

// The same image and the same tree, whatever renders them (docs/design/testing.md).

namespace treefarm::test {
namespace {

/// Every layer that the program has.
constexpr const char* kAovs =
    "albedo,normal,geometric_normal,depth,distance,position,uv,shape,material,alpha,direct,indirect,spp";

struct Hashes {
    std::string image, tree, aovs;
    std::string worst{};  ///< the sample of the most noise, with where its light comes from
    bool operator==(const Hashes&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Hashes& h) {
    return out << "image " << h.image << " tree " << h.tree << " AOVs " << h.aovs << " worst sample " << h.worst;
}

/// `options` begin with the scene. `learns`: the render is to have a tree. `thins`: and vertices without next event.
Hashes render_scene(const std::vector<std::string>& launcher, const std::vector<std::string>& options,
                    bool learns = true, const char* aovs = kAovs, bool thins = false) {
    const auto folder = fresh_folder("same");
    Program program(launcher + std::vector<std::string>{TREEFARM_PROGRAM, "render"} + options +
                    std::vector<std::string>{"--set", std::string("output.aovs=") + aovs, "--set",
                                             "farm.update_seconds=0.05", "--run-dir", folder.string()});
    const Ending ending = program.wait(240);
    EXPECT_EQ(ending.code, 0) << ending.output;
    const nlohmann::json summary = read_summary(folder);
    EXPECT_EQ(summary["state"], "done") << ending.output;
    if (summary["state"] != "done") return {};
    EXPECT_EQ(summary["farm"]["reissued_units"], 0);
    EXPECT_GE(summary["passes"].size(), 3u) << "the test must exercise several passes";
    if (learns) {
        EXPECT_GT(summary["passes"].back()["tree_regions"], 8) << "the test must exercise the tree";
    }
    if (thins) {
        EXPECT_LT(summary["passes"].back()["next_event_samples"], 0.9) << "the test must exercise learned next event";
    }
    std::filesystem::remove_all(folder);
    const nlohmann::json& tails = summary["tail_worst"];
    const std::string worst = tails.empty() ? "" : tails[0].dump();
    if (*aovs == '\0') return {summary["image_hash"], summary["tree_hash"], "", worst};
    EXPECT_NE(summary["aov_hash"], "");
    return {summary["image_hash"], summary["tree_hash"], summary["aov_hash"], worst};
}

Hashes render_by(const std::vector<std::string>& launcher, const std::vector<std::string>& options) {
    return render_scene(launcher, std::vector<std::string>{own_scene("cornell-box.xml"), "-D", "size=64", "--spp", "60",
                                                           "--set", "guiding.spatial_threshold=500"} +
                                      options);
}

const Hashes& one_thread() {
    static const Hashes hashes = render_by({}, {"--threads", "1"});
    return hashes;
}

/// A scene on a tiny film in one process, and under mpirun with each of these numbers of ranks.
void expect_same_bits(const std::string& scene, const std::vector<int>& ranks,
                      const std::vector<std::string>& more = {}, bool learns = true, bool thins = false) {
    std::vector<std::string> options = {scene,
                                        "--set",
                                        "image.width=36",
                                        "--set",
                                        "image.height=24",
                                        "--spp",
                                        "60",
                                        "--set",
                                        "guiding.spatial_threshold=200",
                                        "--set",
                                        "farm.tile_size=8",
                                        "--threads",
                                        "1"};
    options.insert(options.end(), more.begin(), more.end());
    const Hashes alone = render_scene({}, options, learns, kAovs, thins);
    EXPECT_FALSE(alone.image.empty());
    for (const int count : ranks)
        EXPECT_EQ(render_scene(mpirun(count), options, learns, kAovs, thins), alone)
            << scene << " with " << count << " ranks";
}

TEST(SameBits, HashesTellImagesApart) {
    const Hashes other = render_by({}, {"--threads", "1", "--set", "sampler.seed=1"});
    EXPECT_NE(other.image, one_thread().image);
    EXPECT_NE(other.tree, one_thread().tree);
}

TEST(SameBits, Threads2) {
    EXPECT_EQ(render_by({}, {"--threads", "2"}), one_thread());
}

TEST(SameBits, Threads5) {
    EXPECT_EQ(render_by({}, {"--threads", "5"}), one_thread());
}

TEST(SameBits, TileSizes) {
    for (const char* size : {"8", "50"})
        EXPECT_EQ(render_by({}, {"--threads", "2", "--set", std::string("farm.tile_size=") + size}), one_thread())
            << size;
}

TEST(SameBits, Ranks1) {
    EXPECT_EQ(render_by(mpirun(1), {}), one_thread());
}

TEST(SameBits, Ranks2) {
    EXPECT_EQ(render_by(mpirun(2), {"--threads", "1"}), one_thread());
}

TEST(SameBits, Ranks3) {
    EXPECT_EQ(render_by(mpirun(3), {"--threads", "1", "--set", "farm.tile_size=8"}), one_thread());
}

TEST(SameBits, Ranks5) {
    EXPECT_EQ(render_by(mpirun(5), {"--threads", "2", "--set", "farm.tile_size=50"}), one_thread());
}

TEST(SameBits, Ranks3OverTcp) {
    EXPECT_EQ(render_by(mpirun(3, {"--mca", "btl", "tcp,self"}), {"--threads", "1"}), one_thread());
}

/// Ranks, threads and tiles change together.
void expect_same_bits_of(const Estimator& estimator, const char* scene) {
    const char* const aovs = !estimator.has_camera_paths()                 ? ""
                             : estimator.sees_light && !estimator.splats() ? kAovs
                                                                           : "albedo,normal,position,shape,alpha,spp";
    const auto render = [&](const std::vector<std::string>& launcher, const char* threads, const char* tile) {
        return render_scene(launcher,
                            {own_scene(scene), "--set", "image.width=72", "--set", "image.height=60", "--spp", "12",
                             "--threads", threads, "--set", std::string("farm.tile_size=") + tile, "--set",
                             std::string("integrator.type=") + estimator.type},
                            false, aovs);
    };
    const Hashes alone = render({}, "1", "32");
    EXPECT_FALSE(alone.image.empty());
    EXPECT_EQ(render({}, "3", "8"), alone) << estimator.type;
    EXPECT_EQ(render(mpirun(1), "3", "50"), alone) << estimator.type;
    EXPECT_EQ(render(mpirun(2), "1", "8"), alone) << estimator.type;
    EXPECT_EQ(render(mpirun(3), "1", "50"), alone) << estimator.type;
    EXPECT_EQ(render(mpirun(5), "1", "32"), alone) << estimator.type;
}

/// Estimators that nothing guides. Those that splat learn which of four lamps light paths start from; under the sky
/// bidirectional passes find out that light paths do not pay.
TEST(SameBits, Estimators) {
    for (const Estimator& estimator : estimators()) {
        if (estimator.guides) continue;
        expect_same_bits_of(estimator, estimator.splats() ? "fixtures.xml" : "glossy-room.xml");
        if (estimator.splats() && estimator.has_camera_paths()) expect_same_bits_of(estimator, "classroom.xml");
    }
}

/// Every guide: ranks, threads and tiles change together.
TEST(SameBits, Guides) {
    EXPECT_GE(guide_types().size(), 3u);
    for (const std::string& word : guide_types()) {
        const auto render = [&](const std::vector<std::string>& launcher, const char* threads, const char* tile) {
            return render_scene(
                launcher, {own_scene("glossy-room.xml"), "--set", "image.width=36", "--set", "image.height=24", "--spp",
                           "28", "--threads", threads, "--set", std::string("farm.tile_size=") + tile, "--set",
                           "guiding.type=" + word, "--set", "guiding.spatial_threshold=200"});
        };
        const Hashes alone = render({}, "1", "32");
        EXPECT_FALSE(alone.image.empty());
        EXPECT_EQ(render({}, "3", "8"), alone) << word;
        EXPECT_EQ(render(mpirun(2), "3", "50"), alone) << word;
        EXPECT_EQ(render(mpirun(3), "1", "8"), alone) << word;
        EXPECT_EQ(render(mpirun(5), "1", "50"), alone) << word;
    }
}

TEST(SameBitsOfScenes, GlossyRoom) {
    expect_same_bits(own_scene("glossy-room.xml"), {3});
}

TEST(SameBitsOfScenes, GlossyRoomByView) {
    expect_same_bits(own_scene("glossy-room.xml"), {2, 3, 5}, {"--set", "guiding.type=\"view\""});
}

TEST(SameBitsOfScenes, GlossyRoomAsInTheThesis) {
    expect_same_bits(own_scene("glossy-room.xml"), {3},
                     {"--set", "guiding.preset=\"thesis\"", "--set", "guiding.view_threshold=50"});
}

TEST(SameBitsOfScenes, DoorAjarSplitOften) {
    expect_same_bits(own_scene("door-ajar.xml"), {2, 3, 5}, {"--set", "guiding.splitting=32"});
}

TEST(SameBitsOfScenes, MixedRoom) {
    expect_same_bits(own_scene("mixed-room.xml"), {3});
}

TEST(SameBitsOfScenes, DiffuseRoom) {
    expect_same_bits(own_scene("diffuse-room.xml"), {3});
}

TEST(SameBitsOfScenes, Caustic) {
    expect_same_bits(own_scene("caustic.xml"), {3});
}

TEST(SameBitsOfScenes, Features) {
    expect_same_bits(own_scene("features.xml"), {2, 3, 5});
}

/// A lamp in a bulb, which next event hardly finds: fewer vertices have light samples from pass to pass.
TEST(SameBitsOfScenes, LearnedNextEvent) {
    for (const char* type : {"none", "view"})
        expect_same_bits(own_scene("bulb.xml"), {2, 3, 5}, {"--set", std::string("guiding.type=") + type}, false, true);
}

TEST(SameBitsOfScenes, Published) {
    for (const char* name : {"spaceship/spaceship-small.xml", "kitchen/kitchen-envmap-small.xml"}) {
        const std::string scene = shared_scene(name);
        if (scene.empty()) GTEST_SKIP() << "../shared/scenes is absent";
        expect_same_bits(scene, {3});
    }
}

}  // namespace
}  // namespace treefarm::test
