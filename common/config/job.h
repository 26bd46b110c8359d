// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "common/film/combination.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Passes in which light sources are sampled directly (next-event estimation).
enum class NextEvent : std::uint8_t {
    never,
    always,
    kickstart,  ///< only in passes that start with fewer than 128 spp done: it teaches the guide, then guiding takes
                ///< over
    automatic,  ///< as while_it_pays; resolved jobs have another value
    while_it_pays,  ///< always, at as few vertices as finished passes show to be enough
};

/// Weights of multiple importance sampling between next event and scattering (Veach 1997).
enum class MisHeuristic : std::uint8_t {
    balance,
    power,
    equal,  ///< 1/2 each if both techniques can draw a sample; no heuristic, for comparison
};

/// Guide of paths: none, the SD-tree (Mueller et al. 2017), the SD-tree with a view-dependent part (Cavus 2020), the
/// latter while it pays, a fixed grid (docs/use/write-a-guide.md), or Q-learning on one (Dahm and Keller 2017).
enum class GuidingType : std::uint8_t {
    none,
    ppg,
    view,
    automatic,  ///< view, while guiding pays
    grid,
    qtable,
};

/// Value of Job::Guiding::bootstrap that leaves the choice to the program.
inline constexpr float kUsualBootstrap = -1.0f;

/// Duration of a technique within a render.
enum class Rule : std::uint8_t {
    usual,          ///< decided by other keys; resolved jobs have another value
    always,         ///< in all passes of the render
    while_it_pays,  ///< while finished passes show that it pays (common/decide)
};

/// Probabilities by which next event chooses among a scene's emitters.
enum class LightSelection : std::uint8_t {
    power,    ///< probability in proportion to power, everywhere
    even,     ///< equal probabilities
    tree,     ///< probability by an estimate of each emitter's contribution at the point
    learned,  ///< tree, corrected per region by what next event has found there
};

/// Russian roulette of guided paths.
enum class GuidingRoulette : std::uint8_t {
    constant,  ///< paths survive with 0.99
    adjoint,   ///< survival by the light that the guide expects of a path, relative to its first vertex
};

/// All inputs of a render besides the scene. Key names, documentation and ranges are in one table, job_keys.cpp; the
/// docs and job.toml are generated from it.
struct Job {
    struct SceneSource {
        std::string file;
        std::map<std::string, std::string> defines;  ///< values of $name in the scene, from -D
        bool lenient = false;
        std::string sensor;              ///< number from 0 on, or id; empty: the file's default
        std::string root;                ///< folder that must contain all files of the scene; empty: no limit
        int max_file_mb = 2147;          ///< limit per file, 10^6 bytes
        int max_image_megapixels = 268;  ///< limit per image, 10^6 pixels
        std::int64_t max_triangles = 0;  ///< limit of all meshes together; 0: memory
    } scene;

    struct Image {
        int width = 0;   ///< pixels; 0: as in the scene
        int height = 0;  ///< pixels; 0: as in the scene
    } image;

    struct Integrator {
        std::string type = "path";  ///< the estimator (config/estimators.h)
        int max_depth = -1;         ///< path edges from the camera; 1: directly visible emitters; -1: no limit
        int rr_depth = 5;           ///< first depth with roulette
        NextEvent next_event = NextEvent::automatic;
        MisHeuristic mis = MisHeuristic::balance;
        LightSelection light_selection = LightSelection::learned;  ///< tree, if no guide learns
        bool strict_normals = false;  ///< discard light on different sides of the geometric and the shading surface
        bool hide_emitters = false;   ///< emitters are invisible to camera rays
        int emitter_samples = 1;      ///< per surface seen by the camera, for estimators that go by numbers
        int bsdf_samples = 1;
        float ao_distance = 0;    ///< scene units; 0: derived from the scene's size
        bool split_glass = true;  ///< follow both reflection and refraction at the first smooth glass
        float light_samples = 0;  ///< mean number of next-event samples per vertex; 0: as by_next_event says
    } integrator;

    struct Bidirectional {
        bool light_image = true;            ///< connect light paths to the lens
        std::string techniques = "all";     ///< techniques that contribute to the image (techniques.h)
        bool weighted = true;               ///< multiple importance sampling between techniques
        Rule light_subpaths = Rule::usual;  ///< usual: while_it_pays if the image uses all techniques
    } bidirectional;

    struct Effects {
        std::set<std::string> off;  ///< names of effects switched off, a listed approximation (effect_switches.h)
    } effects;

    struct Guiding {
        GuidingType type = GuidingType::automatic;
        Rule rule = Rule::usual;          ///< usual: while_it_pays if the type is auto
        std::string preset;               ///< "" or a preset's name; recorded with the result
        float bsdf_fraction = 0.5f;       ///< probability of sampling the BSDF and not the guide, (0, 1]
        bool learn_bsdf_fraction = true;  ///< learn it per region, starting from bsdf_fraction
        SpatialFilter spatial_filter = SpatialFilter::stochastic;
        DirectionalFilter directional_filter = DirectionalFilter::box;
        GuidingTarget target = GuidingTarget::radiance;
        GuidingRoulette roulette = GuidingRoulette::adjoint;
        int splitting = 0;                  ///< most paths that a path may split into at a vertex; 0: by the type
        Rule splitting_rule = Rule::usual;  ///< usual: while_it_pays if splitting is 0
        int candidates = 1;                 ///< candidate directions drawn at a guided vertex, of which one is used
        int candidate_depth = 1;            ///< last depth with several candidates
        ViewRecords view_records = ViewRecords::product;
        int view_threshold = 4000;            ///< c of the split rule of views
        double spatial_threshold = 0;         ///< c of the spatial split rule; 0: by the film's size
        float directional_threshold = 0.01f;  ///< share of a region's energy above which a cell splits
        int grid_halvings = 0;                ///< halvings of space: a grid has 2^this regions; 0: default
        float bootstrap =
            kUsualBootstrap;             ///< share of a record that comes from what regions have learned before, [0, 1]
        int spp_unit = 1;                ///< samples per pixel of the first pass; passes double
        std::string initial_model;       ///< run directory whose model guides the first pass; empty: none
        std::string initial_model_hash;  ///< of the model's file
        int initial_model_spp = 0;       ///< of the pass that taught it; shorter passes do not teach
        Combination combination = Combination::inverse_variance;
    } guiding;

    struct Budget {
        std::uint32_t spp = 64;  ///< samples per pixel in all passes, unless seconds or error is set
        double seconds = 0;      ///< wall-clock seconds from the first worker's readiness on; 0: no such budget
        double error = 0;        ///< rmse / mean luminance at which to stop; 0: no such budget
        std::uint32_t max_spp = 1 << 20;  ///< limit of renders by seconds or error
        bool strict = false;  ///< the image is the last pass alone, of a length fixed before it began: exactly unbiased
    } budget;

    struct Sampler {
        std::uint64_t seed = 0;
    } sampler;

    struct Farm {
        int tile_size = 32;              ///< pixels
        bool profile = false;            ///< measure the time of each phase of tracing
        double heartbeat_seconds = 1.0;  ///< interval of heartbeats, either way
        double update_seconds = 1.5;     ///< interval at which a worker sends finished units
        double checkpoint_seconds = 5;   ///< least interval between checkpoints; 0: no checkpoints
        double leave_seconds = 10;       ///< time that a worker told to leave may spend on the units it has begun
        std::string isa = "avx2";  ///< Embree's instruction set, equal on all workers: sse2, sse4.2, avx, avx2, avx512
        bool robust = false;       ///< rays neither slip through shared edges nor start behind corners
        bool memory_check = true;  ///< refuse to begin if a host has less memory than the render is expected to need
        bool join = false;         ///< workers may join during the render (treefarm join)
        int join_port = 0;         ///< port at which rank 0 listens; 0: chosen by the kernel
        std::string join_address = "127.0.0.1";  ///< address at which rank 0 listens
    } farm;

    struct Output {
        std::string directory;             ///< run directory; empty: runs/<scene>-<time>
        std::string file;                  ///< -o: a second copy of the image
        std::string aovs;                  ///< layers besides colour, comma-separated (aov_list.h)
        bool half = false;                 ///< EXR colours as 16-bit floats
        std::string compression = "auto";  ///< of EXR: none, rle, zips, zip, piz, or auto (not in resolved jobs)
        int tiles = 0;                     ///< edge of the EXR file's tiles, pixels; 0: scan lines
        bool keep_checkpoint = true;       ///< keep the checkpoint of a finished render
    } output;
};

}  // namespace treefarm
