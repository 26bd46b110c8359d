// SPDX-License-Identifier: Apache-2.0
#include "common/config/job_key_makers.h"

namespace treefarm {
namespace {

/// The key guiding.bsdf_fraction: a number, or (by default) learned.
JobKey bsdf_fraction_key() {
    JobKey key = number_key(
        "guiding.bsdf_fraction", "more than 0, at most 1; or \"learned\" per region of the tree",
        "probability of sampling the BSDF instead of the guide",
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
        "beta of Q-learning: share of the estimate learned in the next vertex' region in the records of a vertex; the "
        "rest is the light that the path itself found; usual: 1 for qtable, else 0",
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
        "guide of paths; ppg: an SD-tree learned from earlier passes (Mueller et al. 2017); view: with a "
        "view-dependent part (Cavus 2020); auto: view, while it pays; grid: fixed regions and strata of directions, "
        "the simplest example of a guide; qtable: Q-learning on such a grid (Dahm and Keller 2017)",
        [](auto& j) -> auto& { return j.guiding.type; },
        std::vector<std::pair<std::string, GuidingType>>{{"none", GuidingType::none},
                                                         {"ppg", GuidingType::ppg},
                                                         {"view", GuidingType::view},
                                                         {"auto", GuidingType::automatic},
                                                         {"grid", GuidingType::grid},
                                                         {"qtable", GuidingType::qtable}}));
    add(rule_key(
        "guiding.rule",
        "passes that are guided; while_it_pays: all but those for which finished passes show a loss; usual: "
        "while_it_pays if guiding.type is auto, else always",
        [](auto& j) -> auto& { return j.guiding.rule; }));
    add(word_key(
        "guiding.preset",
        "settings of a publication, applied before all other keys; paper: Mueller et al. 2017, improved: with its "
        "authors' additions of 2019, thesis: Cavus 2020",
        [](auto& j) -> auto& { return j.guiding.preset; },
        std::vector<std::pair<std::string, std::string>>{
            {"", ""}, {"paper", "paper"}, {"improved", "improved"}, {"thesis", "thesis"}}));
    add(word_key(
        "guiding.view_records",
        "records of view-dependent vertices; radiance: incident radiance for the view, nothing for the region (Cavus "
        "2020); product: reflected radiance for the view, incident radiance for the region",
        [](auto& j) -> auto& { return j.guiding.view_records; },
        std::vector<std::pair<std::string, ViewRecords>>{{"radiance", ViewRecords::radiance},
                                                         {"product", ViewRecords::product}}));
    add(integer_key(
        "guiding.view_threshold", "1 and more",
        "c of the split rule of views: a view splits into four above c sqrt(spp / 4) records",
        [](auto& j) -> auto& { return j.guiding.view_threshold; }, 1, kMaxInt));
    add(bsdf_fraction_key());
    add(number_key(
        "guiding.spatial_threshold", "0, or 1 to 10^9",
        "c of the spatial split rule: a region splits above c sqrt(spp / 4) records; 0: 2000 (pixels / 2^18)^(1/4)",
        [](auto& j) -> auto& { return j.guiding.spatial_threshold; },
        [](double v) { return v == 0.0 || (v >= 1.0 && v <= 1e9); }));
    add(number_key(
        "guiding.directional_threshold", "0.0005 to 1",
        "share of a region's energy above which a directional cell splits; with view and auto up to twice as much "
        "where the BSDF is sampled more often than the tree",
        [](auto& j) -> auto& { return j.guiding.directional_threshold; },
        [](float v) { return v >= 0.0005f && v <= 1.0f; }));
    add(integer_key(
        "guiding.grid_halvings", "0, or 1 to 18",
        "grid and qtable: halvings of space, along x, y and z in turn, which give 2^this regions; 0: 12, or 15 for "
        "qtable",
        [](auto& j) -> auto& { return j.guiding.grid_halvings; }, 0, 18));
    add(bootstrap_key());
    add(integer_key(
        "guiding.spp_unit", "1 to 65536", "samples per pixel of the first pass; passes double",
        [](auto& j) -> auto& { return j.guiding.spp_unit; }, 1, 65536));
    add(text_key(
        "guiding.initial_model", "run directory of a render whose model guides the first pass; empty: none",
        [](auto& j) -> auto& { return j.guiding.initial_model; }));
    add(text_key(
        "guiding.initial_model_hash",
        "hash of the initial model's tree.bin, set by the render; a file with another hash is refused",
        [](auto& j) -> auto& { return j.guiding.initial_model_hash; }));
    add(integer_key(
        "guiding.initial_model_spp", "0 to 2^30",
        "samples per pixel of the pass that taught the initial model; shorter passes do not teach",
        [](auto& j) -> auto& { return j.guiding.initial_model_spp; }, 0, kMaxSpp));
    add(word_key(
        "guiding.combination",
        "combination of passes into one image; fixed: exactly unbiased; last: only passes with the last tree",
        [](auto& j) -> auto& { return j.guiding.combination; },
        std::vector<std::pair<std::string, Combination>>{{"inverse_variance", Combination::inverse_variance},
                                                         {"fixed", Combination::fixed},
                                                         {"last", Combination::last}}));
    add(integer_key(
        "guiding.candidates", "1 to 4",
        "candidate directions drawn at a guided vertex; one is chosen by the product of BSDF and learned light",
        [](auto& j) -> auto& { return j.guiding.candidates; }, 1, 4));
    add(integer_key(
        "guiding.candidate_depth", "1 and more",
        "last vertex, counted from the camera, that draws candidates; deeper ones draw one direction",
        [](auto& j) -> auto& { return j.guiding.candidate_depth; }, 1, kMaxInt));
    add(word_key("guiding.spatial_filter",
                 "region that a record is added to; stochastic: that of its position moved by up to half a region",
                 [](auto& j) -> auto& { return j.guiding.spatial_filter; },
                 std::vector<std::pair<std::string, SpatialFilter>>{{"nearest", SpatialFilter::nearest},
                                                                    {"stochastic", SpatialFilter::stochastic}},
                 {{"box", "use \"stochastic\", whose expectation is the box filter's"}}));
    add(word_key(
        "guiding.directional_filter",
        "directional cells that a record is added to; box: all in a square of its cell's size",
        [](auto& j) -> auto& { return j.guiding.directional_filter; },
        std::vector<std::pair<std::string, DirectionalFilter>>{{"nearest", DirectionalFilter::nearest},
                                                               {"box", DirectionalFilter::box}}));
    add(word_key(
        "guiding.target",
        "quantity in proportion to which directions are sampled: mean radiance, or the root of its second moment",
        [](auto& j) -> auto& { return j.guiding.target; },
        std::vector<std::pair<std::string, GuidingTarget>>{{"radiance", GuidingTarget::radiance},
                                                           {"variance", GuidingTarget::variance}}));
    add(word_key(
        "guiding.roulette",
        "roulette of guided paths; adjoint: by the radiance expected of a path; constant: 0.99, as in the program of "
        "2017",
        [](auto& j) -> auto& { return j.guiding.roulette; },
        std::vector<std::pair<std::string, GuidingRoulette>>{{"adjoint", GuidingRoulette::adjoint},
                                                             {"constant", GuidingRoulette::constant}}));
    add(integer_key(
        "guiding.splitting", "0 to 32",
        "most paths that a path may split into at a vertex, if it is expected to carry several times the light "
        "expected at its first vertex; 0: 8 with guiding.type view or auto and roulette adjoint, while it pays, else 1",
        [](auto& j) -> auto& { return j.guiding.splitting; }, 0, 32));
    add(rule_key(
        "guiding.splitting_rule",
        "passes that split paths; while_it_pays: until a pass shows that it does not pay; usual: while_it_pays if "
        "guiding.splitting is 0, else always",
        [](auto& j) -> auto& { return j.guiding.splitting_rule; }));
    return keys;
}

}  // namespace treefarm
