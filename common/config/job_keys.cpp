// SPDX-License-Identifier: Apache-2.0
#include "common/config/job_keys.h"

#include <limits>

#include "common/base/text/parse_text.h"
#include "common/config/aov_list.h"
#include "common/config/effect_switches.h"
#include "common/config/estimators.h"
#include "common/config/job_key_makers.h"
#include "common/config/quantities.h"
#include "common/config/techniques.h"

namespace treefarm {
namespace {

/// The key integrator.type; its values come from the list of estimators.
JobKey estimator_key() {
    std::vector<std::pair<std::string, std::string>> words;
    std::string meaning = "how the image is estimated;";
    for (const Estimator& estimator : estimators()) {
        meaning += std::string(words.empty() ? " " : "; ") + estimator.type + ": " + estimator.meaning;
        words.emplace_back(estimator.type, estimator.type);
    }
    JobKey key = word_key(
        "integrator.type", "", [](auto& j) -> auto& { return j.integrator.type; }, std::move(words));
    key.doc = meaning;
    return key;
}

/// Value of an effect's key that does not switch it off.
constexpr const char* kWhereCalledFor = "where_called_for";

/// The key that switches an effect off.
JobKey effect_key(const EffectSwitch& effect) {
    const std::string name = effect.name;
    return {kEffectsPrefix + name,
            ValueKind::off_switch,
            in_quotes(kWhereCalledFor) + " or false",
            std::string(kWhereCalledFor) + " (or auto): on if the scene uses it; false: " + effect.replacement,
            [name](Job& job, const std::string& text) {
                if (text == "false") job.effects.off.insert(name);
                const bool called_for = text == kWhereCalledFor || text == "auto";
                if (called_for) job.effects.off.erase(name);
                return text == "false" || called_for;
            },
            [name](const Job& job) { return std::string(job.effects.off.contains(name) ? "false" : kWhereCalledFor); },
            {}};
}

/// The key integrator.light_samples: a number, or (by default, 0) decided by next event.
JobKey light_samples_key() {
    constexpr const char* kByNextEvent = "by_next_event";
    JobKey key = number_key(
        "integrator.light_samples", "0 to 1, or \"by_next_event\"",
        "share of the vertices at which next event samples an emitter, equal everywhere, for comparisons; lights "
        "without extent are always sampled; by_next_event, or 0: decided by integrator.next_event",
        [](auto& j) -> auto& { return j.integrator.light_samples; }, [](float v) { return v >= 0.0f && v <= 1.0f; });
    key.kind = ValueKind::number_or_text;
    key.parse = [number = key.parse](Job& job, const std::string& text) {
        return number(job, text == kByNextEvent ? "0" : text);
    };
    key.print = [number = key.print](const Job& job) {
        return job.integrator.light_samples == 0 ? std::string(kByNextEvent) : number(job);
    };
    return key;
}

/// The key output.aovs: layers besides colour.
JobKey aovs_key() {
    std::string range;
    for (const AovKind& kind : aov_kinds())
        range += (range.empty() ? "list of \"" : "\", \"") + std::string(kind.name);
    return {"output.aovs",
            ValueKind::text_list,
            range + R"("; "NAME:depth" calls the layer NAME)",
            "layers of the image besides colour (docs/use/outputs.md)",
            [](Job& job, const std::string& text) {
                std::string why, canonical;
                const std::vector<AovRequest> requests = parse_aovs(text, why);
                if (!why.empty()) return false;
                for (const AovRequest& request : requests)
                    canonical += (canonical.empty() ? "" : ",") + aov_text(request);
                job.output.aovs = canonical;
                return true;
            },
            [](const Job& job) { return job.output.aovs; },
            {},
            [](const std::string& text) {
                std::string why;
                parse_aovs(text, why);
                return why;
            }};
}

/// The key integrator.techniques of bidirectional paths.
JobKey techniques_key() {
    return {
        "bidirectional.techniques",
        ValueKind::text,
        R"("all", or pairs of vertices from lamp and camera, as "0,3 1,2")",
        "techniques that contribute to the image, each with its share of the light: their images add up to the whole",
        [](Job& job, const std::string& text) {
            std::string why;
            const std::vector<Technique> techniques = parse_techniques(text, why);
            if (why.empty()) job.bidirectional.techniques = techniques_text(techniques);
            return why.empty();
        },
        [](const Job& job) { return job.bidirectional.techniques; },
        {},
        [](const std::string& text) {
            std::string why;
            parse_techniques(text, why);
            return why;
        }};
}

std::vector<JobKey> make_job_keys() {
    std::vector<JobKey> keys;
    const auto add = [&](JobKey key) { keys.push_back(std::move(key)); };

    add(text_key(
        "scene.file", "the scene to render; relative to the folder of the job file",
        [](auto& j) -> auto& { return j.scene.file; }));
    add(boolean_key(
        "scene.lenient",
        "replace or skip, with a warning, parts of the scene that cannot be rendered; otherwise they are errors",
        [](auto& j) -> auto& { return j.scene.lenient; }));

    add(text_key(
        "scene.sensor",
        "which of several sensors: its number from 0 on, or its id; empty: the first (in files of version 0.x the "
        "last)",
        [](auto& j) -> auto& { return j.scene.sensor; }));

    add(text_key(
        "scene.root",
        "folder that must contain all files of the scene, links followed: for untrusted scenes; empty: no limit",
        [](auto& j) -> auto& { return j.scene.root; }));
    add(integer_key(
        "scene.max_file_mb", "1 to 2147", "greatest size of a file of the scene, 10^6 bytes",
        [](auto& j) -> auto& { return j.scene.max_file_mb; }, 1, 2147));
    add(integer_key(
        "scene.max_image_megapixels", "1 to 268", "greatest size of an image of the scene, 10^6 pixels",
        [](auto& j) -> auto& { return j.scene.max_image_megapixels; }, 1, 268));
    add(integer_key(
        "scene.max_triangles", "0 to 2^40", "greatest number of triangles of all meshes together; 0: no limit",
        [](auto& j) -> auto& { return j.scene.max_triangles; }, 0, std::int64_t{1} << 40));
    add(integer_key(
        "image.width", "0 to 65535", "pixels; 0: as in the scene", [](auto& j) -> auto& { return j.image.width; }, 0,
        65535));
    add(integer_key(
        "image.height", "0 to 65535", "pixels; 0: as in the scene", [](auto& j) -> auto& { return j.image.height; }, 0,
        65535));

    add(estimator_key());
    add(integer_key(
        "integrator.max_depth", "-1, or 1 and more",
        "greatest number of path edges from the camera; 1: directly visible emitters; -1: no limit",
        [](auto& j) -> auto& { return j.integrator.max_depth; }, 1, kMaxInt, -1));
    add(integer_key(
        "integrator.rr_depth", "1 and more", "Russian roulette ends paths from this depth on",
        [](auto& j) -> auto& { return j.integrator.rr_depth; }, 1, kMaxInt));
    add(word_key(
        "integrator.next_event",
        "passes that sample emitters directly; kickstart: those that start with fewer than 128 spp done; "
        "while_it_pays: all, at every vertex, a quarter or a sixteenth of them, decided from finished passes, or at "
        "every vertex if these may not decide (presets, budget.strict, other weights); auto: chosen by the program, at "
        "present while_it_pays",
        [](auto& j) -> auto& { return j.integrator.next_event; },
        std::vector<std::pair<std::string, NextEvent>>{{"always", NextEvent::always},
                                                       {"never", NextEvent::never},
                                                       {"kickstart", NextEvent::kickstart},
                                                       {"while_it_pays", NextEvent::while_it_pays},
                                                       {"auto", NextEvent::automatic}}));
    add(light_samples_key());
    add(word_key(
        "integrator.mis", "MIS heuristic between next event and scattering (Veach 1997); equal: weights of 1/2",
        [](auto& j) -> auto& { return j.integrator.mis; },
        std::vector<std::pair<std::string, MisHeuristic>>{
            {"power", MisHeuristic::power}, {"balance", MisHeuristic::balance}, {"equal", MisHeuristic::equal}}));
    add(word_key(
        "integrator.light_selection",
        "probabilities by which next event chooses an emitter; power: by power; even: equal; tree: by an estimate of "
        "its contribution at the point; learned: corrected by what next event has found in the region, or tree if "
        "nothing is learned",
        [](auto& j) -> auto& { return j.integrator.light_selection; },
        std::vector<std::pair<std::string, LightSelection>>{{"power", LightSelection::power},
                                                            {"even", LightSelection::even},
                                                            {"tree", LightSelection::tree},
                                                            {"learned", LightSelection::learned}}));
    add(boolean_key(
        "integrator.strict_normals", "discard light on different sides of the geometric and the shading surface",
        [](auto& j) -> auto& { return j.integrator.strict_normals; }));
    add(boolean_key(
        "integrator.hide_emitters", "the camera does not see emitters directly",
        [](auto& j) -> auto& { return j.integrator.hide_emitters; }));
    add(boolean_key(
        "integrator.split_glass",
        "paths follow both reflection and refraction at smooth glass that the camera sees, instead of one at random",
        [](auto& j) -> auto& { return j.integrator.split_glass; }));

    add(integer_key(
        "integrator.emitter_samples", "0 to 65535", "direct: emitter samples per visible surface point",
        [](auto& j) -> auto& { return j.integrator.emitter_samples; }, 0, 65535));
    add(integer_key(
        "integrator.bsdf_samples", "0 to 65535", "direct: BSDF samples per visible surface point",
        [](auto& j) -> auto& { return j.integrator.bsdf_samples; }, 0, 65535));
    add(number_key(
        "integrator.ao_distance", "0 and more",
        "ao: distance up to which surfaces darken, in scene units; 0: a quarter of the diagonal of the scene's box",
        [](auto& j) -> auto& { return j.integrator.ao_distance; }, [](float v) { return v >= 0.0f; }));

    add(boolean_key(
        "bidirectional.light_image", "connect light paths to the lens, too",
        [](auto& j) -> auto& { return j.bidirectional.light_image; }));
    add(rule_key(
        "bidirectional.light_subpaths",
        "passes whose samples have a light subpath; while_it_pays: until a pass shows that it does not pay, or all if "
        "only such paths find some of the light; usual: while_it_pays, or always if techniques are listed",
        [](auto& j) -> auto& { return j.bidirectional.light_subpaths; }));
    add(techniques_key());
    add(boolean_key(
        "bidirectional.weighted",
        "weight techniques against each other (MIS); false: each shows all the light that it finds, for comparisons",
        [](auto& j) -> auto& { return j.bidirectional.weighted; }));

    for (const EffectSwitch& effect : effect_switches())
        add(effect_key(effect));

    for (JobKey& key : guiding_keys())
        add(std::move(key));

    add(integer_key(
        "budget.spp", "1 to 2^30", "samples per pixel in all passes, unless `budget.seconds` or `budget.error` is set",
        [](auto& j) -> auto& { return j.budget.spp; }, 1, kMaxSpp));
    add(number_key(
        "budget.seconds", R"(0, or 0.001 to 10^8; or with a unit in quotes: "90s", "2min", "1h")",
        "wall-clock seconds from the first worker's request for work to the end of the last pass; 0: no such budget",
        [](auto& j) -> auto& { return j.budget.seconds; },
        [](double v) { return v == 0.0 || (v >= kLeastSeconds && v <= kMostSeconds); }, &parse_duration));
    add(number_key(
        "budget.error", "0, or 10^-6 to 1; or in percent, in quotes: \"5%\"",
        "estimated RMSE / mean luminance at which to stop: 0.05 or \"5%\"; 0: no such budget",
        [](auto& j) -> auto& { return j.budget.error; },
        [](double v) { return v == 0.0 || (v >= kLeastError && v <= kGreatestError); }, &parse_fraction));
    add(integer_key(
        "budget.max_spp", "1 to 2^30", "greatest number of samples per pixel with `budget.seconds` or `budget.error`",
        [](auto& j) -> auto& { return j.budget.max_spp; }, 1, kMaxSpp));
    add(boolean_key(
        "budget.strict", "the image is the last pass alone, whose length is fixed before it begins: exactly unbiased",
        [](auto& j) -> auto& { return j.budget.strict; }));

    add(integer_key(
        "sampler.seed", "0 to 2^63 - 1", "two seeds give independent images",
        [](auto& j) -> auto& { return j.sampler.seed; }, 0, std::numeric_limits<std::int64_t>::max()));

    add(integer_key(
        "farm.tile_size", "1 to 1024", "pixels along the edge of a tile; no influence on the image",
        [](auto& j) -> auto& { return j.farm.tile_size; }, 1, 1024));
    add(boolean_key(
        "farm.profile",
        "measure the phases of tracing, for the columns profile_* of passes.csv; costs about 2 % of the time",
        [](auto& j) -> auto& { return j.farm.profile; }));
    const auto seconds = [](double v) { return v >= 0.001 && v <= 3600.0; };
    add(number_key(
        "farm.heartbeat_seconds", "0.001 to 3600", "interval of heartbeats between coordinator and workers",
        [](auto& j) -> auto& { return j.farm.heartbeat_seconds; }, seconds));
    add(number_key(
        "farm.update_seconds", "0.001 to 3600",
        "interval at which a worker sends finished units; longer if splats to a large film would fill the network",
        [](auto& j) -> auto& { return j.farm.update_seconds; }, seconds));
    add(number_key(
        "farm.checkpoint_seconds", "0 to 86400",
        "least seconds between checkpoints; 0: none is written, and the render cannot be resumed",
        [](auto& j) -> auto& { return j.farm.checkpoint_seconds; }, [](double v) { return v >= 0 && v <= 86400; }));
    add(number_key(
        "farm.leave_seconds", "0 to 3600",
        "seconds that a worker told to leave (SIGTERM) may spend on tiles that it has begun",
        [](auto& j) -> auto& { return j.farm.leave_seconds; }, [](double v) { return v >= 0 && v <= 3600; }));
    const std::vector<std::pair<std::string, std::string>> isas{
        {"sse2", "sse2"}, {"sse4.2", "sse4.2"}, {"avx", "avx"}, {"avx2", "avx2"}, {"avx512", "avx512"}};
    add(word_key(
        "farm.isa", "Embree's instruction set, equal on all workers", [](auto& j) -> auto& { return j.farm.isa; },
        isas));
    add(boolean_key(
        "farm.robust",
        "watertight: no ray slips through an edge that two triangles share, or starts behind a corner; much slower",
        [](auto& j) -> auto& { return j.farm.robust; }));
    add(boolean_key(
        "farm.memory_check", "refuse to begin if a host has less memory than its processes are expected to need",
        [](auto& j) -> auto& { return j.farm.memory_check; }));
    add(boolean_key(
        "farm.join", "accept workers that join during the render (docs/use/join.md)",
        [](auto& j) -> auto& { return j.farm.join; }));
    add(integer_key(
        "farm.join_port", "0 to 65535", "port for joining workers; 0: any free one",
        [](auto& j) -> auto& { return j.farm.join_port; }, 0, 65535));
    add(text_key(
        "farm.join_address", "address of this machine for joining workers; 0.0.0.0 or :: for all of its addresses",
        [](auto& j) -> auto& { return j.farm.join_address; }));

    add(text_key(
        "output.directory", "the run directory; empty: runs/<scene>-<time>",
        [](auto& j) -> auto& { return j.output.directory; }));
    add(text_key(
        "output.file", "second copy of the image (an .exr file, or a .png for viewing); empty: none",
        [](auto& j) -> auto& { return j.output.file; }));
    add(aovs_key());
    add(boolean_key(
        "output.half",
        "image.exr stores colours, normals and alpha as 16-bit floats; variance, distances, positions, uv and numbers "
        "stay 32 bits wide",
        [](auto& j) -> auto& { return j.output.half; }));
    const std::vector<std::pair<std::string, std::string>> compressions{
        {"auto", "auto"}, {"none", "none"}, {"rle", "rle"}, {"zips", "zips"}, {"zip", "zip"}, {"piz", "piz"}};
    add(word_key(
        "output.compression",
        "compression of image.exr, always lossless; auto: rle if all channels are floats, else zip",
        [](auto& j) -> auto& { return j.output.compression; }, compressions));
    add(integer_key(
        "output.tiles", "0, or 16 to 4096", "edge of the tiles in image.exr, pixels; 0: scan lines",
        [](auto& j) -> auto& { return j.output.tiles; }, 16, 4096, 0));
    add(boolean_key(
        "output.keep_checkpoint", "keep the checkpoint of a render that is done, so that resume can add samples to it",
        [](auto& j) -> auto& { return j.output.keep_checkpoint; }));
    return keys;
}

}  // namespace

std::span<const JobKey> job_keys() {
    static const std::vector<JobKey> keys = make_job_keys();
    return keys;
}

const JobKey* find_job_key(const std::string& name) {
    for (const JobKey& key : job_keys())
        if (key.name == name) return &key;
    return nullptr;
}

std::string job_key_documentation() {
    const Job defaults;
    std::string text = "| key | values | default | meaning |\n|---|---|---|---|\n";
    for (const JobKey& key : job_keys()) {
        const std::string value = key.stored() ? key.print(defaults) : "";
        text += "| `" + key.name + "` | " + key.range + " | " + (value.empty() ? "" : "`" + value + "`") + " | " +
                key.doc + " |\n";
    }
    text += "| `scene.defines.NAME` | text | | value for `$NAME` in the scene, as -D NAME=value |\n";
    return text;
}

}  // namespace treefarm
