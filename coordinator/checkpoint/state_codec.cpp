// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/state_codec.h"

#include <algorithm>
#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/common.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <utility>

#include "common/base/hash.h"
#include "common/film/pixel_codec.h"
#include "common/protocol/archive.h"
#include "common/protocol/plan_fields.h"

namespace treefarm {

// Fields of each part of a state. A change of any of them raises the version of its section.

template <class Archive>
void serialize(Archive& a, Rgb64& v) {
    a(v.x, v.y, v.z);
}

template <class Archive>
void serialize(Archive& a, Moments& m) {
    a(m.n, m.mean, m.m2);
}

template <class Archive>
void serialize(Archive& a, PixelEstimate& p) {
    a(p.half[0], p.half[1]);
}

template <class Archive>
void serialize(Archive& a, ErrorEstimate& e) {
    a(e.known, e.has_interval, e.rmse, e.low, e.high, e.mean);
}

template <class Archive>
void serialize(Archive& a, BudgetMemory& m) {
    a(m.probed, m.ending);
}

template <class Archive>
void serialize(Archive& a, PassFacts& f) {
    a(f.spp, f.spp_before, f.mse_of_sample, f.stuv_trimmed, f.collect_seconds, f.overhead_seconds, f.trace_core_seconds,
      f.record_core_seconds, f.threads, f.record, f.next_event);
}

/// All fields but threads, which may change on resume.
template <class Archive>
void serialize(Archive& a, RenderHistory& h) {
    a(h.passes, h.seconds, h.error, h.decisions, h.budget);
}

template <class Archive>
void serialize(Archive& a, HalfNoise& n) {
    a(n.variance, n.samples);
}

template <class Archive>
void serialize(Archive& a, SampleNoise& n) {
    a(n.passes, n.half);
}

template <class Archive>
void serialize(Archive& a, PassPart& p) {
    a(p.spp, p.spp_before);
}

/// All fields but the pixels.
template <class Archive>
void serialize(Archive& a, PassResult& p) {
    a(p.spp, p.spp_before, p.same_tree, p.new_technique, p.guided, p.noise, p.parts, p.stored);
}

template <class Archive>
void serialize(Archive& a, Spread& s) {
    a(s.min, s.mean, s.max, s.max_worker);
}

template <class Archive>
void serialize(Archive& a, PassSeconds& s) {
    a(s.all, s.broadcast, s.collect, s.merge, s.refine, s.film, s.error, s.trace, s.splat, s.worker, s.idle);
}

template <class Archive>
void serialize(Archive& a, InvalidSample& s) {
    a(s.pass, s.x, s.y, s.sample, s.rgb[0], s.rgb[1], s.rgb[2]);
}

template <class Archive>
void serialize(Archive& a, TailSample& s) {
    a(s.noise, s.pass, s.x, s.y, s.sample, s.origin.found, s.origin.path_class, s.origin.vertices);
}

template <class Archive>
void serialize(Archive& a, TraceStats& s) {
    a(s.paths, s.nonzero_paths, s.rays, s.shadow_rays, s.vertices, s.records, s.split_path_rays, s.invalid_samples,
      s.first_invalid, s.tails.worst, s.trace_seconds, s.splat_seconds, s.phase_seconds);
}

template <class Archive>
void serialize(Archive& a, PassVariance& v) {
    a(v.stuv, v.stuv_trimmed, v.mse_of_sample, v.stuv_ppg);
}

template <class Archive>
void serialize(Archive& a, ErrorForecast& f) {
    a(f.relative_error, f.spp, f.seconds, f.trust);
}

template <class Archive>
void serialize(Archive& a, TreeFigures& f) {
    a(f.nodes, f.regions, f.views, f.cells, f.spatial_depth, f.directional_depth, f.bytes, f.memory);
}

template <class Archive>
void serialize(Archive& a, UpdateCaps& c) {
    a(c.capped_records, c.saturated_cells, c.outside_positions);
}

template <class Archive>
void serialize(Archive& a, SplatCaps& c) {
    a(c.capped, c.rejected);
}

/// All fields but the origins, which are not needed after a resume, and next event, which is a decision.
template <class Archive>
void serialize(Archive& a, RefineReport& r) {
    a(r.spatial_depth_capped, r.directional_depth_capped, r.memory_capped, r.spatial_depth, r.directional_depth,
      r.mean_cells, r.views_capped);
}

template <class Archive>
void serialize(Archive& a, PassReport& r) {
    a(r.plan, r.spp_done, r.workers, r.threads, r.seconds, r.stats, r.variance, r.error, r.decisions, r.run_seconds,
      r.halving, r.target, r.tree, r.update_bytes, r.touched_cells, r.caps, r.splat_caps, r.splat_bytes,
      r.saturated_splats, r.refine);
}

template <class Archive>
void serialize(Archive& a, WorkUnit& u) {
    a(u.pass, u.x0, u.y0, u.x1, u.y1, u.chunk, u.kind, u.first, u.count);
}

template <class Archive>
void serialize(Archive& a, PoisonUnit& d) {
    a(d.unit, d.deaths);
}

/// All fields but the layers, which are sections of their own.
template <class Archive>
void serialize(Archive& a, PartialPass& p) {
    a(p.plan, p.memory, p.done, p.stats, p.update_bytes, p.splat_bytes, p.touched_cells, p.poison_units,
      p.collect_seconds, p.run_seconds);
}

template <class Archive>
void serialize(Archive& a, CheckpointOrigin& o) {
    a(o.fingerprint, o.build, o.scene_hash, o.resolved, o.output_file, o.schedule, o.pixels);
}

namespace {

constexpr std::uint32_t kOrigin = section_tag("IDNT"), kHistory = section_tag("FACT"), kFilms = section_tag("FILM"),
                        kAovs = section_tag("AOVS"), kModel = section_tag("MODL"), kLearner = section_tag("LERN"),
                        kReports = section_tag("RPRT"), kPartial = section_tag("OPEN"),
                        kPartialFilm = section_tag("PFLM"), kPartialAovs = section_tag("PAOV"),
                        kPartialSplats = section_tag("PSPL"), kPartialEvidence = section_tag("PEVI");

constexpr std::uint32_t version_of(std::uint32_t tag) {
    if (tag == kReports) return 7;
    if (tag == kHistory || tag == kPartial) return 6;
    return tag == kLearner ? 3 : 1;
}

/// `room`: capacity to reserve in bytes, for large sections.
template <class... T>
Section section_with_capacity(std::size_t capacity, std::uint32_t tag, const T&... values) {
    ByteWriter writer;
    writer.reserve(capacity);
    WriteArchive archive(writer);
    archive(values...);
    return {tag, version_of(tag), writer.take()};
}

template <class... T>
Section section(std::uint32_t tag, const T&... values) {
    return section_with_capacity(0, tag, values...);
}

/// Upper bound of the bytes of a pixel's AOV sums, with all AOVs.
std::size_t most_aov_bytes() {
    std::vector<AovRequest> all;
    for (const AovKind& kind : aov_kinds())
        all.push_back({kind.aov, kind.name});
    return sizeof(double) * AovLayout(all).size() + sizeof(Rgb64);
}

template <class... T>
void read(const SectionFile& file, std::uint32_t tag, T&... values) {
    ByteReader reader(file.at(tag, version_of(tag)).bytes);
    ReadArchive archive(reader);
    archive(values...);
    reader.expect_end();
}

void require(bool condition, const char* what) {
    if (!condition) throw FormatError(what);
}

/// Whether a noise measurement belongs to the films from number `first` on.
bool fits(const SampleNoise& noise, std::size_t films) {
    return noise.passes <= films && std::all_of(noise.half.begin(), noise.half.end(), [&](const HalfNoise& half) {
               return half.samples.size() <= noise.passes;
           });
}

}  // namespace

bool is_film_name(const std::string& name) {
    return name.size() == 41 && name.starts_with("film-") && name.ends_with(".tff") &&
           name.find_first_not_of("0123456789abcdef", 5) == 37;
}

namespace {

/// All sections but the layers of a partial pass.
std::vector<Section> encode_fields(const CheckpointOrigin& origin, const RenderState& state) {
    // Reserved at once: growth would copy it, with both copies in memory.
    const std::size_t capacity = state.aovs.requested() ? 64 + most_aov_bytes() * origin.pixels : 0;
    std::vector<Section> sections;  // an initialiser list would copy each
    sections.push_back(section(kOrigin, origin));
    sections.push_back(section(kHistory, state.history));
    sections.push_back(section(kFilms, state.films));
    sections.push_back(section_with_capacity(capacity, kAovs, state.aovs));
    sections.push_back(section(kModel, state.tree.encode(), state.last_tree, state.tree_hash));
    sections.push_back(section(kLearner, state.learner));
    sections.push_back(section(kReports, state.reports));
    if (state.partial) sections.push_back(section(kPartial, *state.partial));
    return sections;
}

/// Layers of a partial pass.
std::array<std::pair<std::uint32_t, Bytes PartialPass::*>, 4> partial_layers() {
    return {{{kPartialFilm, &PartialPass::film},
             {kPartialAovs, &PartialPass::aovs},
             {kPartialSplats, &PartialPass::splats},
             {kPartialEvidence, &PartialPass::evidence}}};
}

}  // namespace

std::vector<Section> encode_state(const CheckpointOrigin& origin, const RenderState& state) {
    std::vector<Section> sections = encode_fields(origin, state);
    if (state.partial)
        for (const auto& [tag, layer] : partial_layers())
            sections.push_back({tag, version_of(tag), *state.partial.*layer});
    return sections;
}

std::vector<Section> take_state(const CheckpointOrigin& origin, RenderState& state) {
    std::vector<Section> sections = encode_fields(origin, state);
    if (state.partial)
        for (const auto& [tag, layer] : partial_layers())
            sections.push_back({tag, version_of(tag), std::move(*state.partial.*layer)});
    state.partial.reset();
    return sections;
}

/// Partial pass of a state, if it has one.
std::optional<PartialPass> decode_partial(const SectionFile& file, std::size_t pixels) {
    if (!file.has(kPartial)) return std::nullopt;
    PartialPass partial;
    read(file, kPartial, partial);
    for (const auto& [tag, layer] : partial_layers())
        partial.*layer = file.at(tag, version_of(tag)).bytes;
    require(partial.plan.spp > 0 && has_possible_units(partial, pixels), "a partial pass of another image");
    return partial;
}

CheckpointOrigin decode_origin(const SectionFile& file) {
    CheckpointOrigin origin;
    read(file, kOrigin, origin);
    return origin;
}

RenderState decode_state(const SectionFile& file, std::size_t pixels, std::span<const AovRequest> aovs) {
    RenderState state;
    state.aovs = AovSums(aovs, pixels);
    read(file, kHistory, state.history);
    read(file, kFilms, state.films);
    read(file, kAovs, state.aovs);
    Bytes tree;
    read(file, kModel, tree, state.last_tree, state.tree_hash);
    state.tree = AnyModel::decode(tree);
    read(file, kLearner, state.learner);
    read(file, kReports, state.reports);
    state.partial = decode_partial(file, pixels);
    require(state.reports.size() == state.history.passes.size(), "not a report for each pass");
    require(!state.reports.empty() || state.partial, "no pass");
    require(state.films.empty() == state.reports.empty(), "no film");
    require(!state.partial || state.partial->plan.index == state.reports.size(), "a partial pass that is not the next");
    for (std::size_t k = 0; k < state.films.size(); ++k) {
        require(is_film_name(state.films[k].stored), "a film without a file");
        require(fits(state.films[k].noise, state.films.size() - k), "noise of other films");
    }
    for (const PassReport& report : state.reports)
        require(report.halving.trust <= Trust::firm && report.target.trust <= Trust::firm && report.plan.spp > 0,
                "an impossible report of a pass");
    require(state.aovs.fits(), "AOVs of another image");
    return state;
}

std::string film_name(std::span<const std::uint8_t> bytes) {
    return "film-" + hash_text(hash128_bytes(bytes)) + ".tff";
}

Bytes encode_pixels(std::span<const PixelEstimate> pixels) {
    ByteWriter writer;
    writer.reserve(pixels.size() * kEstimateBytes);
    for (const PixelEstimate& pixel : pixels)
        put_estimate(writer, pixel);
    return writer.take();
}

std::vector<PixelEstimate> decode_pixels(std::span<const std::uint8_t> bytes, std::size_t count) {
    if (bytes.size() != count * kEstimateBytes)
        throw FormatError("its film has " + std::to_string(bytes.size()) + " bytes, not those of " +
                          std::to_string(count) + " pixels");
    ByteReader reader(bytes);
    std::vector<PixelEstimate> pixels(count);
    for (PixelEstimate& pixel : pixels)
        pixel = get_estimate(reader);
    return pixels;
}

}  // namespace treefarm
