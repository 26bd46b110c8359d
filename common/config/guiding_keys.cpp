// SPDX-License-Identifier: Apache-2.0
#include "common/config/guiding_keys.h"

#include <limits>

#include "common/config/job_key_makers.h"

namespace treefarm {
namespace {

constexpr std::int64_t kMaxInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMaxSpp = std::int64_t{1} << 30;

/// The key guiding.bsdf_fraction: a number, or (by default) learned.
JobKey bsdf_fraction_key() {
    JobKey key = number_key(
        "guiding.bsdf_fraction", "more than 0, at most 1; or \"learned\" per region of the tree",
        "probability of sampling the BSDF rather than the tree",
        [](auto& j) -> auto& { return j.guiding.bsdf_fraction; }, [](float v) { return v > 0.0f && v <= 1.0f; });
    key.kind = ValueKind::number_or_text;
    key.parse = [number = key.parse](Job& job, const std::string& text) {
        const bool learned = text == "learned";
        if (learned)
            job.guiding.bsdf_fraction = Job().guiding.bsdf_fraction;
        else if (!number(job, text))
            return false;
        job.guiding.learn_bsdf_fraction = learned;
        return true;
    };
    key.print = [number = key.print](const Job& job) {
        return job.guiding.learn_bsdf_fraction ? std::string("learned") : number(job);
    };
    return key;
}

/// The key guiding.bootstrap: a number, or (by default) the program's choice.
JobKey bootstrap_key() {
    JobKey key = number_key(
        "guiding.bootstrap", "0 to 1, or \"usual\"",
        "beta of Q-learning: which part of what a vertex learns of the light behind its next vertex is what that one's "
        "region has learned, the rest what the path found; usual: 1 of a qtable, else 0",
        [](auto& j) -> auto& { return j.guiding.bootstrap; }, [](float v) { return v >= 0.0f && v <= 1.0f; });
    key.kind = ValueKind::number_or_text;
    key.parse = [number = key.parse](Job& job, const std::string& text) {
        if (text != "usual") return number(job, text);
        job.guiding.bootstrap = kUsualBootstrap;
        return true;
    };
    key.print = [number = key.print](const Job& job) {
        return job.guiding.bootstrap == kUsualBootstrap ? std::string("usual") : number(job);
    };
    return key;
}

}  // namespace

std::vector<JobKey> guiding_keys() {
    std::vector<JobKey> keys;
    const auto add = [&](JobKey key) { keys.push_back(std::move(key)); };

    add(word_key(
        "guiding.type",
        "what guides paths; ppg: a tree learned from the passes before (Mueller et al. 2017); view: with a "
        "view-dependent "
        "part (Cavus 2020); auto: that, as long as it pays; grid: fixed regions and strata of directions, the simplest "
        "guide to learn from; qtable: Q-learning on the same (Dahm and Keller 2017)",
        [](auto& j) -> auto& { return j.guiding.type; },
        std::vector<std::pair<std::string, GuidingType>>{{"none", GuidingType::none},
                                                         {"ppg", GuidingType::ppg},
                                                         {"view", GuidingType::view},
                                                         {"auto", GuidingType::automatic},
                                                         {"grid", GuidingType::grid},
                                                         {"qtable", GuidingType::qtable}}));
    add(rule_key(
        "guiding.rule",
        "when a tree guides; while_it_pays: but in passes before which finished ones show that it loses; usual: that "
        "where "
        "guiding.type is auto, else always",
        [](auto& j) -> auto& { return j.guiding.rule; }));
    add(word_key(
        "guiding.preset",
        "a publication's settings, applied before all other keys; paper: Mueller et al. 2017, improved: with what its "
        "authors added in 2019, thesis: Cavus 2020",
        [](auto& j) -> auto& { return j.guiding.preset; },
        std::vector<std::pair<std::string, std::string>>{
            {"", ""}, {"paper", "paper"}, {"improved", "improved"}, {"thesis", "thesis"}}));
    add(word_key(
        "guiding.view_records",
        "what a view-dependent vertex teaches: its view the radiance that arrives and its region nothing (Cavus 2020), "
        "or its view what it reflects and its region the radiance",
        [](auto& j) -> auto& { return j.guiding.view_records; },
        std::vector<std::pair<std::string, ViewRecords>>{{"radiance", ViewRecords::radiance},
                                                         {"product", ViewRecords::product}}));
    add(integer_key(
        "guiding.view_threshold", "1 and more",
        "c of the split rule of views: one splits into four above c sqrt(spp / 4) records",
        [](auto& j) -> auto& { return j.guiding.view_threshold; }, 1, kMaxInt));
    add(bsdf_fraction_key());
    add(number_key(
        "guiding.spatial_threshold", "0, or 1 to 10^9",
        "c of the spatial split rule: a region splits above c sqrt(spp / 4) records; 0: 2000 (pixels / 2^18)^(1/4)",
        [](auto& j) -> auto& { return j.guiding.spatial_threshold; },
        [](double v) { return v == 0.0 || (v >= 1.0 && v <= 1e9); }));
    add(number_key(
        "guiding.directional_threshold", "0.0005 to 1",
        "share of a region's energy above which a directional cell splits; in view and auto up to twice as much where "
        "the BSDF is sampled rather than the tree",
        [](auto& j) -> auto& { return j.guiding.directional_threshold; },
        [](float v) { return v >= 0.0005f && v <= 1.0f; }));
    add(integer_key(
        "guiding.grid_halvings", "0, or 1 to 18",
        "grid and qtable: halvings of space, in turn along x, y and z: 2^this regions; 0: 12, or 15 of a qtable",
        [](auto& j) -> auto& { return j.guiding.grid_halvings; }, 0, 18));
    add(bootstrap_key());
    add(integer_key(
        "guiding.spp_unit", "1 to 65536", "samples per pixel of the first pass; passes double",
        [](auto& j) -> auto& { return j.guiding.spp_unit; }, 1, 65536));
    add(text_key(
        "guiding.initial_model", "begin with what the render in this run directory has learned; empty: nothing",
        [](auto& j) -> auto& { return j.guiding.initial_model; }));
    add(text_key(
        "guiding.initial_model_hash", "of its tree.bin, as the render finds it; where one is given, another is refused",
        [](auto& j) -> auto& { return j.guiding.initial_model_hash; }));
    add(integer_key(
        "guiding.initial_model_spp", "0 to 2^30", "samples of the pass that taught it; shorter ones do not teach",
        [](auto& j) -> auto& { return j.guiding.initial_model_spp; }, 0, kMaxSpp));
    add(word_key(
        "guiding.combination",
        "how the passes become one image; fixed is exactly unbiased, last keeps the passes of the last tree",
        [](auto& j) -> auto& { return j.guiding.combination; },
        std::vector<std::pair<std::string, Combination>>{{"inverse_variance", Combination::inverse_variance},
                                                         {"fixed", Combination::fixed},
                                                         {"last", Combination::last}}));
    add(integer_key(
        "guiding.candidates", "1 to 4",
        "directions drawn at a guided vertex, of which one is taken by the product of BSDF and learned light",
        [](auto& j) -> auto& { return j.guiding.candidates; }, 1, 4));
    add(integer_key(
        "guiding.candidate_depth", "1 and more", "vertices from the camera that draw so many; deeper ones draw one",
        [](auto& j) -> auto& { return j.guiding.candidate_depth; }, 1, kMaxInt));
    add(word_key("guiding.spatial_filter",
                 "which region a record goes to; stochastic: that of its position moved by up to half a region",
                 [](auto& j) -> auto& { return j.guiding.spatial_filter; },
                 std::vector<std::pair<std::string, SpatialFilter>>{{"nearest", SpatialFilter::nearest},
                                                                    {"stochastic", SpatialFilter::stochastic}},
                 {{"box", "use \"stochastic\", whose expectation is the box filter's"}}));
    add(word_key(
        "guiding.directional_filter",
        "how a record spreads over directional cells; box: over a square of its cell's size",
        [](auto& j) -> auto& { return j.guiding.directional_filter; },
        std::vector<std::pair<std::string, DirectionalFilter>>{{"nearest", DirectionalFilter::nearest},
                                                               {"box", DirectionalFilter::box}}));
    add(word_key(
        "guiding.target",
        "what directions are sampled in proportion to: mean radiance, or the root of its second moment",
        [](auto& j) -> auto& { return j.guiding.target; },
        std::vector<std::pair<std::string, GuidingTarget>>{{"radiance", GuidingTarget::radiance},
                                                           {"variance", GuidingTarget::variance}}));
    add(word_key(
        "guiding.roulette",
        "once a tree guides: by the radiance that it expects of a path, or the constant 0.99 of the program of 2017",
        [](auto& j) -> auto& { return j.guiding.roulette; },
        std::vector<std::pair<std::string, GuidingRoulette>>{{"adjoint", GuidingRoulette::adjoint},
                                                             {"constant", GuidingRoulette::constant}}));
    add(integer_key(
        "guiding.splitting", "0 to 32",
        "as how many paths one may go on at a vertex, where the tree expects it to carry several times what its first "
        "vertex does; 0: 8 where guiding.type is view or auto and roulette adjoint, as long as it pays, else 1",
        [](auto& j) -> auto& { return j.guiding.splitting; }, 0, 32));
    add(rule_key(
        "guiding.splitting_rule",
        "how long paths are split; while_it_pays: until a pass shows that it does not; usual: that where "
        "guiding.splitting is 0, else always",
        [](auto& j) -> auto& { return j.guiding.splitting_rule; }));
    return keys;
}

}  // namespace treefarm
