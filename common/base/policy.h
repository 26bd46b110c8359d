// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace treefarm {

/// All constants that were tuned on scenes instead of derived, grouped by the decision that they are for.
/// docs/generated/policy.md explains each and gives its source. A render records them in resolved.toml. This header
/// includes no other of the project, so that every module may include it.
struct Policy {
    /// Whether paths are guided ("auto"), judged by what guided samples estimate for unguided ones.
    struct Guiding {
        std::uint32_t least_judged_spp = 4;
        double ray_cost = 1.4;
        double mistrusted = 2.0;
        double giving_up = 0.85;
        double giving_up_early = 0.75;
        double giving_up_errors = 1.3;
        double taking_up = 1.1;
        std::uint32_t least_settled_spp = 16;
        std::uint32_t settled_spp = 64;
        double least_known = 4.0;
    } guiding;

    /// Share of vertices at which next event samples emitters ("auto").
    struct NextEvent {
        std::uint32_t counted_every = 8;
        double least_vertices = 512.0;
        double lent_vertices = 256.0;
        double standard_errors = 2.0;
        double least_gain = 0.03;
        double learned = 0.1;
        double sample_cost = 0.25;
        double shadow_ray_cost = 1.0;
        double least_rest = 0.02;
    } next_event;

    /// Light level around a pixel, in relation to which noise is measured.
    struct Levels {
        double least = 0.1;
        std::size_t block = 8;
    } levels;

    /// Splitting: number of paths that one splits into, and when splitting is given up.
    struct Splitting {
        int usual = 8;
        float least_share = 1.4f;
        double least_quietened = 1.01;
        double least_found = 0.99;
        std::uint32_t least_spp = 16;
        double least_gain = 0.97;
        double least_gain_alone = 0.9;
        double shown_gain = 2.2;
        double copy_ray_cost = 1.4;
    } splitting;

    /// Light subpaths of bidirectional samples: when they are given up, and which emitters they start from.
    struct LightSubpaths {
        double ray_cost = 1.7;
        double least_gain = 0.9;
        double least_found = 0.95;
        std::uint32_t least_spp = 4;
        double most_of_mean = 32.0;
        double missed_errors = 1.0;
        double prior_paths = 128.0;
        float unlearned = 0.2f;
    } light_subpaths;

    /// Russian roulette, candidates, and glass seen by the camera.
    struct Walk {
        float adjoint_window = 4.0f;
        float adjoint_least = 0.5f;
        float adjoint_most = 0.95f;
        float unguided_window = 2.0f;
        float unguided_most = 0.95f;
        float untrained_least = 0.1f;
        float guided_survival = 0.99f;
        float candidate_fair = 0.2f;
        float split_often = 4.0f;
        float split_least = 0x1p-12f;
    } walk;

    /// Learning and growth of the tree.
    struct Learning {
        double spatial_threshold = 2000.0;
        double product_cells = 0.5;
        double free_cells = 1 << 16;
        double least_use = 0.5;
        double lights_unlearned = 0.2;
        double lights_prior_vertices = 128.0;
        double least_bsdf_fraction = 0.05;
        double mixture_prior_records = 64.0;
        double idle_fraction = 0.05;
        int idle_passes = 2;
        double least_view_gain = 0.1;
        double least_view_gain_of_all = 0.015;
        int initial_depth = 4;
        double kept_evidence = 0.5;
    } learning;

    /// Guides with even regions and strata of directions.
    struct Grids {
        int halvings = 12;
        int table_halvings = 15;
        double even_part = 0.1;
        double table_floor = 0.02;
    } grids;

    /// Division of lamps, and the tree of them by which next event chooses.
    struct Lights {
        float least_cut = 1.0f / 32;
        std::size_t few_triangles = 16;
        double small_share = 1.0 / 64;
        double least_area = 1e-3;
        std::size_t far_lanes = 4;
    } lights;

    /// Expected brightness of splats.
    struct Splats {
        double nearest = 0x1p-16;
        double alike = 16.0;
    } splats;

    /// Lengths of passes, and which of them count.
    struct Schedule {
        std::uint32_t kickstart_spp = 128;
        double teaching_share = 3.0;
        std::uint32_t guessed_spp = 64;
        std::uint32_t samples_per_unit = 1u << 18;
        std::uint32_t least_weighed_spp = 4;
        double kickstart_weight = 0.5;
    } schedule;

    /// Distribution of work: no influence on the image.
    struct Farm {
        double half_life = 2.0;
        double most_seconds = 2.0;
        double part = 0.25;
        double copy_gain = 0.1;
        double copy_ratio = 1.0;
    } farm;

    /// End of renders with a budget of seconds or error.
    struct Budget {
        double time_tolerance = 0.05;
        double least_tolerance = 1.0;
        double most_tolerance = 0.1;
        double hedge = 0.7;
        double probe = 0.07;
        std::uint32_t spp_to_believe = 16;
        std::uint32_t spp_to_believe_zero = 64;
        double least_share = 1.0 / 16;
        double error_margin = 1.02;
        double strict_error_margin = 1.10;
        double least_left = 0.25;
        double worth_hedging = 0.5;
        double most_late = 0.75;
    } budget;

    /// Progress expected from further trees.
    struct Forecast {
        double learned = 0.55;
        double noisy = 0.1;
        double far = 16.0;
        double fading = 0.75;
        double cost_fading = 0.35;
        double least_progress = 0.25;
        double most_cost_ratio = 1.6;
        int trees_at_rest = 3;
        double recording_share = 0.12;
    } forecast;

    /// Reports on few samples that carry much of an image's noise.
    struct Tails {
        double outlier = 0.25;
        double noise_part = 0.4;
        double told_share = 0.001;
        std::uint32_t least_pixels = 4096;
    } tails;
};

inline constexpr Policy kPolicy{};

}  // namespace treefarm
