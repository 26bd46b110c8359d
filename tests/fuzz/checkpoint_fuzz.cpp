// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/base/error.h"
#include "common/film/pixel_codec.h"
#include "coordinator/checkpoint/state_codec.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

namespace {

constexpr std::size_t kPixels = 6;

RenderState small_state() {
    RenderState state;
    state.tree = SdTreeGuide::first(Box3(Vec3(0.0f), Vec3(1.0f)), {});
    state.last_tree = true;
    state.films.push_back({4, 0, std::vector<PixelEstimate>(kPixels)});
    state.films[0].stored = "film-" + std::string(32, 'a') + ".tff";
    state.films[0].parts = {{1, 0}, {3, 1}};
    state.films[0].noise.passes = 1;
    state.films[0].noise.half[0] = {0.5, {2}};
    PassPlan guided;
    guided.spp = 8;
    GuidingEvidence evidence{.samples = 8, .guided_cost = 3, .unguided_cost = 2};
    evidence.guided.fill(0.5);
    state.history.decisions.get<GuidingDecision::Memory>().passes.after_guided(guided, evidence);
    PassFacts facts;
    facts.spp = 4;
    state.history.passes.push_back(facts);
    PassReport report;
    report.plan.spp = 4;
    report.seconds.worker = {{1, 0.5}, {2, 0.25}};
    report.stats.first_invalid.push_back({});
    report.stats.tails.add({2.5f, 0, 1, 0, 3, {LightFound::sampled, PathClass::mirror, 4}});
    state.reports.push_back(report);
    PartialPass partial;
    partial.plan.index = 1;
    partial.plan.spp = 8;
    partial.plan.units.light_paths = 2;
    partial.done = DoneWork(3, 2, 1);
    partial.done.add({1, 0, 0, 2, 1, 0});
    partial.done.add({.pass = 1, .kind = UnitKind::light_paths, .first = 3, .count = 4});
    partial.poison_units = {{{1, 2, 1, 3, 2, 0}, 1}};
    partial.film.resize(2 * kEstimateBytes);
    state.partial = partial;
    return state;
}

const SectionFile& small_file() {
    static const SectionFile file = [] {
        CheckpointOrigin origin;
        origin.schedule.resize(2);
        origin.pixels = kPixels;
        return SectionFile{1, encode_state(origin, small_state())};
    }();
    return file;
}

}  // namespace

/// 'f': a whole file follows; another first byte: the content of the section of that number, as check sums let little
/// pass.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::uint8_t> rest(data + 1, size - 1);
    try {
        SectionFile file = small_file();
        if (data[0] == 'f')
            file = decode_sections(rest);
        else
            file.sections[data[0] % file.sections.size()].bytes.assign(rest.begin(), rest.end());
        const CheckpointOrigin origin = decode_origin(file);
        const RenderState state = decode_state(file, kPixels, {});
        // What was read is written as what reads back to the same.
        const SectionFile again{2, encode_state(origin, state)};
        if (encode_state(decode_origin(again), decode_state(again, kPixels, {})) != again.sections) std::abort();
    } catch (const FormatError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    std::vector<std::string> seeds;
    const Bytes whole = encode_sections(small_file());
    seeds.push_back("f" + std::string(whole.begin(), whole.end()));
    for (std::size_t k = 0; k < small_file().sections.size(); ++k) {
        const Bytes& bytes = small_file().sections[k].bytes;
        seeds.push_back(std::string(1, static_cast<char>(k)) + std::string(bytes.begin(), bytes.end()));
    }
    return seeds;
}
