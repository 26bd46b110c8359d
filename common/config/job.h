// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "common/film/combination.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// When light sources are sampled directly (next-event estimation).
enum class NextEvent : std::uint8_t {
    never,
    always,
    kickstart,      ///< only in passes that start with fewer than 128 spp done: it teaches the tree, then guiding takes
                    ///< over
    automatic,      ///< as while_it_pays; only a job has it, never a resolved one
    while_it_pays,  ///< always, but at as few vertices as finished passes show to be enough, where they may decide
};

/// Weights of multiple importance sampling between next event and scattering (Veach 1997).
enum class MisHeuristic : std::uint8_t {
    balance,
    power,
    equal,  ///< one half each wherever both techniques can draw a sample: no heuristic at all, to measure by
};

/// The guide of paths: nothing, the SD-tree (Mueller et al. 2017), the SD-tree with a view-dependent part (Cavus 2020),
/// the last as long as it pays, a fixed grid (docs/use/write-a-guide.md), or Q-learning on one (Dahm and Keller 2017).
enum class GuidingType : std::uint8_t {
    none,
    ppg,
    view,
    automatic,  ///< view, as long as guiding pays
    grid,
    qtable,
};

/// Job::Guiding::bootstrap that is left to the program.
inline constexpr float kUsualBootstrap = -1.0f;

/// How long what a render has begun with goes on.
enum class Rule : std::uint8_t {
    usual,          ///< as other keys say; only a job has it, never a resolved one
    always,         ///< to the end
    while_it_pays,  ///< as finished passes show that it pays (film/guiding_efficiency.h, film/splitting_gain.h)
};

/// How next event chooses among a scene's emitters.
enum class LightSelection : std::uint8_t {
    power,    ///< by power, everywhere the same
    even,     ///< all alike
    tree,     ///< by an estimate of what each brings to the point
    learned,  ///< and per region, by what next event found there
};

/// How guided paths end.
enum class GuidingRoulette : std::uint8_t {
    constant,  ///< paths survive with 0.99
    adjoint,   ///< by what the tree expects of them, against what it expected of their first vertex
};

/// Everything that a render depends on besides the scene. Keys, documentation, defaults and ranges stand in one table
/// in job_keys.cpp; docs and job.toml are written from it.
struct Job {
    struct SceneSource {
        std::string file;
        std::map<std::string, std::string> defines;  ///< values for $name in the scene, from -D
        bool lenient = false;
        std::string sensor;      ///< number from 0 on, or id; empty: the file's own choice
        std::string root;        ///< folder that holds all that the scene may read; empty: it may read what it names
        int max_file_mb = 2147;  ///< of one file, 10^6 bytes
        int max_image_megapixels = 268;  ///< of one image, 10^6 pixels
        std::int64_t max_triangles = 0;  ///< of all meshes; 0: what memory holds
    } scene;

    struct Image {
        int width = 0;   ///< pixels; 0: as the scene says
        int height = 0;  ///< pixels; 0: as the scene says
    } image;

    struct Integrator {
        std::string type = "path";  ///< the estimator (config/estimators.h)
        int max_depth = -1;         ///< path edges from the camera; 1 sees emitters only; -1: no limit
        int rr_depth = 5;           ///< roulette from this depth on
        NextEvent next_event = NextEvent::automatic;
        MisHeuristic mis = MisHeuristic::balance;
        LightSelection light_selection = LightSelection::learned;  ///< where nothing learns: tree
        bool strict_normals = false;  ///< drop light that geometric and shading normal disagree about
        bool hide_emitters = false;   ///< the camera does not see emitters directly
        int emitter_samples = 1;      ///< per surface that the camera sees, where the estimator goes by numbers
        int bsdf_samples = 1;
        float ao_distance = 0;    ///< scene units; 0: by the scene's size
        bool split_glass = true;  ///< at the first surface: both ways out of smooth glass
        float light_samples = 0;  ///< of next event at each vertex, on average; 0: by_next_event, as that says
    } integrator;

    struct Bidirectional {
        bool light_image = true;            ///< light paths are connected to the lens
        std::string techniques = "all";     ///< of which the image is made (techniques.h)
        bool weighted = true;               ///< techniques share the light that several find
        Rule light_subpaths = Rule::usual;  ///< usual: while_it_pays where the image is made of all techniques
    } bidirectional;

    struct Effects {
        std::set<std::string> off;  ///< forced off, a listed approximation: names of effect_switches.h
    } effects;

    struct Guiding {
        GuidingType type = GuidingType::automatic;
        Rule rule = Rule::usual;          ///< usual: while_it_pays where the type is auto
        std::string preset;               ///< "" or a preset's name: recorded so that the result says what was asked
        float bsdf_fraction = 0.5f;       ///< probability of sampling the BSDF rather than the tree, (0, 1]
        bool learn_bsdf_fraction = true;  ///< per region, from bsdf_fraction on
        SpatialFilter spatial_filter = SpatialFilter::stochastic;
        DirectionalFilter directional_filter = DirectionalFilter::box;
        GuidingTarget target = GuidingTarget::radiance;
        GuidingRoulette roulette = GuidingRoulette::adjoint;
        int splitting = 0;                  ///< as how many paths one may go on at a vertex; 0: as the type says
        Rule splitting_rule = Rule::usual;  ///< usual: while_it_pays where splitting is 0
        int candidates = 1;                 ///< directions drawn at a guided vertex, of which one is taken
        int candidate_depth = 1;            ///< up to which depth
        ViewRecords view_records = ViewRecords::product;
        int view_threshold = 4000;            ///< c of the split rule of views
        double spatial_threshold = 0;         ///< c of the spatial split rule; 0: as the film says
        float directional_threshold = 0.01f;  ///< share of a region's energy above which a cell splits
        int grid_halvings = 0;                ///< of space: a grid has 2^this regions; 0: as usual
        float bootstrap = kUsualBootstrap;    ///< part of records that regions have learned before, [0, 1]
        int spp_unit = 1;                     ///< samples per pixel of the first pass; passes double
        std::string initial_model;            ///< run directory whose model the first pass is guided by; empty: none
        std::string initial_model_hash;       ///< of its file
        int initial_model_spp = 0;            ///< of the pass that taught it; shorter passes do not teach
        Combination combination = Combination::inverse_variance;
    } guiding;

    struct Budget {
        std::uint32_t spp = 64;           ///< samples per pixel in all passes, unless seconds or error is set
        double seconds = 0;               ///< of the clock, from the first worker's readiness on; 0: no such budget
        double error = 0;                 ///< rmse / mean luminance at which to stop; 0: no such budget
        std::uint32_t max_spp = 1 << 20;  ///< where seconds and error end at the latest
        bool strict = false;              ///< the last pass alone, of a length set before it began: exactly unbiased
    } budget;

    struct Sampler {
        std::uint64_t seed = 0;
    } sampler;

    struct Farm {
        int tile_size = 32;              ///< pixels
        bool profile = false;            ///< time the parts of tracing
        double heartbeat_seconds = 1.0;  ///< how often each side says that it lives
        double update_seconds = 1.5;     ///< how often a worker sends what it has finished
        double checkpoint_seconds = 5;   ///< least time from checkpoint to checkpoint; 0: none
        double leave_seconds = 10;       ///< how long a worker that is told to leave goes on with what it has begun
        std::string isa =
            "avx2";           ///< Embree's instruction set, the same on every worker: sse2, sse4.2, avx, avx2, avx512
        bool robust = false;  ///< rays neither slip through shared edges nor start behind corners
        bool memory_check = true;  ///< no render begins where a host has less memory than is expected to be taken
        bool join = false;         ///< workers may join while it runs (treefarm join)
        int join_port = 0;         ///< port of rank 0 to listen at; 0: the kernel chooses
        std::string join_address = "127.0.0.1";  ///< address of rank 0 to listen at
    } farm;

    struct Output {
        std::string directory;             ///< the run directory; empty: runs/<scene>-<time>
        std::string file;                  ///< -o: also write the image here
        std::string aovs;                  ///< layers besides colour, with commas between (aov_list.h)
        bool half = false;                 ///< EXR stores colours as 16-bit floats
        std::string compression = "auto";  ///< of EXR: auto, never of a resolved job; none, rle, zips, zip, piz
        int tiles = 0;                     ///< edge of the EXR file's tiles, pixels; 0: scan lines
        bool keep_checkpoint = true;       ///< of a render that is done
    } output;
};

}  // namespace treefarm
