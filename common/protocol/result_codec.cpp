// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/result_codec.h"

namespace treefarm {

namespace {

void write_moments(double* out, const Moments& moments) {
    for (int c = 0; c < 3; ++c) {
        out[c] = moments.mean[c];
        out[3 + c] = moments.m2[c];
    }
}

Moments read_moments(std::uint32_t n, const double* in) {
    return {n, Rgb64(in[0], in[1], in[2]), Rgb64(in[3], in[4], in[5])};
}

/// Writes estimates of pixels with equal numbers of samples.
void write_pixels(ByteWriter& writer, const std::vector<PixelEstimate>& pixels, const std::uint32_t (&n)[2]) {
    std::vector<double> values(pixels.size() * 12);
    double* out = values.data();
    for (const PixelEstimate& pixel : pixels)
        for (int half = 0; half < 2; ++half, out += 6) {
            if (pixel.half[half].n != n[half])
                throw RunError("pixels of a work unit differ in their number of samples");
            write_moments(out, pixel.half[half]);
        }
    writer.put_array(std::span<const double>(values));
}

/// Reads estimates of `count` pixels.
std::vector<PixelEstimate> read_pixels(ByteReader& reader, std::size_t count, std::uint32_t n0, std::uint32_t n1) {
    const std::vector<double> values = reader.get_array<double>();
    if (values.size() != std::size_t{12} * count) throw FormatError("a work unit with the wrong number of pixels");
    std::vector<PixelEstimate> pixels;
    pixels.reserve(count);
    for (std::size_t at = 0; at < values.size(); at += 12)
        pixels.push_back({{read_moments(n0, &values[at]), read_moments(n1, &values[at + 6])}});
    return pixels;
}

void write_unit_result(ByteWriter& writer, const UnitResult& result) {
    const std::vector<PixelEstimate>& pixels = result.pixels;
    if (!pixels.empty() && pixels.size() != result.unit.pixel_count())
        throw RunError("a work unit was finished with the wrong number of pixels");
    write_unit(writer, result.unit);
    if (result.unit.kind != UnitKind::tile) return;
    writer.put<std::uint8_t>(pixels.empty() ? 0 : 1);
    if (pixels.empty()) return;
    const std::uint32_t n[2] = {pixels[0].half[0].n, pixels[0].half[1].n};
    writer.put(n[0]);
    writer.put(n[1]);
    write_pixels(writer, pixels, n);
    writer.put_array(std::span<const double>(result.aovs.values));
    writer.put<std::uint8_t>(result.aovs.direct.empty() ? 0 : 1);
    if (!result.aovs.direct.empty()) write_pixels(writer, result.aovs.direct, n);
}

/// Reads the byte that tells whether an optional part follows.
bool read_presence(ByteReader& reader) {
    const auto present = reader.get<std::uint8_t>();
    if (present > 1) throw FormatError("a part of a work unit that is neither there nor absent");
    return present == 1;
}

UnitResult read_unit_result(ByteReader& reader, std::uint32_t pass) {
    UnitResult result;
    result.unit = read_unit(reader, pass);
    if (result.unit.kind != UnitKind::tile) return result;
    if (!read_presence(reader)) return result;
    const auto n0 = reader.get<std::uint32_t>();
    const auto n1 = reader.get<std::uint32_t>();
    result.pixels = read_pixels(reader, result.unit.pixel_count(), n0, n1);
    result.aovs.values = reader.get_array<double>();
    if (read_presence(reader)) result.aovs.direct = read_pixels(reader, result.unit.pixel_count(), n0, n1);
    return result;
}

void write_stats(ByteWriter& writer, const TraceStats& s) {
    for (const std::uint64_t count :
         {s.paths, s.nonzero_paths, s.rays, s.shadow_rays, s.vertices, s.records, s.split_path_rays, s.invalid_samples})
        writer.put_varint(count);
    writer.put(s.trace_seconds);
    writer.put(s.splat_seconds);
    for (const double seconds : s.phase_seconds)
        writer.put(seconds);
    writer.put(s.busy_seconds);
    writer.put_varint(s.first_invalid.size());
    for (const InvalidSample& sample : s.first_invalid) {
        writer.put(sample.pass);
        writer.put(sample.x);
        writer.put(sample.y);
        writer.put(sample.sample);
        for (const float value : sample.rgb)
            writer.put(value);
    }
    writer.put_varint(s.tails.worst.size());
    for (const TailSample& sample : s.tails.worst) {
        writer.put(sample.noise);
        writer.put(sample.pass);
        writer.put(sample.x);
        writer.put(sample.y);
        writer.put(sample.sample);
        writer.put(static_cast<std::uint8_t>(sample.origin.found));
        writer.put(static_cast<std::uint8_t>(sample.origin.path_class));
        writer.put(sample.origin.vertices);
    }
}

constexpr std::size_t kInvalidSampleBytes = 24, kTailSampleBytes = 19;

TailSample read_tail(ByteReader& reader) {
    TailSample sample;
    sample.noise = reader.get<float>();
    sample.pass = reader.get<std::uint32_t>();
    sample.x = reader.get<std::uint16_t>();
    sample.y = reader.get<std::uint16_t>();
    sample.sample = reader.get<std::uint32_t>();
    sample.origin.found = static_cast<LightFound>(reader.get<std::uint8_t>());
    sample.origin.path_class = static_cast<PathClass>(reader.get<std::uint8_t>());
    sample.origin.vertices = reader.get<std::uint8_t>();
    if (!is_known(sample.origin)) throw FormatError("light that comes from nowhere");
    return sample;
}

TraceStats read_stats(ByteReader& reader) {
    TraceStats s;
    for (std::uint64_t* count : {&s.paths, &s.nonzero_paths, &s.rays, &s.shadow_rays, &s.vertices, &s.records,
                                 &s.split_path_rays, &s.invalid_samples})
        *count = reader.get_varint();
    s.trace_seconds = reader.get<double>();
    s.splat_seconds = reader.get<double>();
    for (double& seconds : s.phase_seconds)
        seconds = reader.get<double>();
    s.busy_seconds = reader.get<double>();
    const std::size_t invalid = reader.get_count(kInvalidSampleBytes);
    for (std::size_t i = 0; i < invalid; ++i) {
        InvalidSample sample;
        sample.pass = reader.get<std::uint32_t>();
        sample.x = reader.get<std::uint16_t>();
        sample.y = reader.get<std::uint16_t>();
        sample.sample = reader.get<std::uint32_t>();
        for (float& value : sample.rgb)
            value = reader.get<float>();
        s.first_invalid.push_back(sample);
    }
    const std::size_t tails = reader.get_count(kTailSampleBytes);
    for (std::size_t i = 0; i < tails; ++i)
        s.tails.worst.push_back(read_tail(reader));
    return s;
}

/// Upper bound of a result's size in bytes.
std::size_t size_bound(const Result& result) {
    constexpr std::size_t kMostVarint = 10, kMostStats = 1024;
    std::size_t bytes = kMostStats + kInvalidSampleBytes * result.stats.first_invalid.size() +
                        kTailSampleBytes * result.stats.tails.worst.size() + result.evidence.size() +
                        result.splats.size();
    for (const UnitResult& unit : result.units)
        bytes += kMostUnitBytes + 2 * sizeof(std::uint32_t) + 2 + 3 * kMostVarint +
                 kPixelBytes * (unit.pixels.size() + unit.aovs.direct.size()) +
                 sizeof(double) * unit.aovs.values.size();
    return bytes;
}

}  // namespace

void write_unit(ByteWriter& writer, const WorkUnit& unit) {
    writer.put(static_cast<std::uint8_t>(unit.kind));
    switch (unit.kind) {
        case UnitKind::tile:
            for (const std::uint16_t edge : {unit.x0, unit.y0, unit.x1, unit.y1})
                writer.put(edge);
            writer.put(unit.chunk);
            return;
        case UnitKind::light_paths:
            writer.put(unit.first);
            writer.put(unit.count);
            return;
        case UnitKind::chains:
            writer.put(static_cast<std::uint32_t>(unit.first));
            writer.put(unit.count);
            return;
    }
}

WorkUnit read_unit(ByteReader& reader, std::uint32_t pass) {
    const auto kind = reader.get<std::uint8_t>();
    if (kind >= kUnitKinds) throw FormatError("a work unit of unknown kind");
    WorkUnit unit{.pass = pass, .kind = static_cast<UnitKind>(kind)};
    if (unit.kind == UnitKind::tile) {
        for (std::uint16_t* edge : {&unit.x0, &unit.y0, &unit.x1, &unit.y1})
            *edge = reader.get<std::uint16_t>();
        unit.chunk = reader.get<std::uint32_t>();
        if (unit.x0 >= unit.x1 || unit.y0 >= unit.y1) throw FormatError("an empty work unit");
        return unit;
    }
    unit.first = unit.kind == UnitKind::light_paths ? reader.get<std::uint64_t>() : reader.get<std::uint32_t>();
    unit.count = reader.get<std::uint32_t>();
    if (unit.count == 0 || unit.first + unit.count < unit.first) throw FormatError("an empty work unit");
    return unit;
}

void write_result(ByteWriter& writer, const Result& result) {
    writer.reserve(size_bound(result));
    writer.put(result.incarnation);
    writer.put(result.pass);
    write_stats(writer, result.stats);
    writer.put_varint(result.units.size());
    for (const UnitResult& unit : result.units)
        write_unit_result(writer, unit);
    writer.put_array(std::span(result.evidence));
    writer.put_array(std::span(result.splats));
}

Result read_result(ByteReader& reader) {
    Result result;
    result.incarnation = reader.get<std::uint64_t>();
    result.pass = reader.get<std::uint32_t>();
    result.stats = read_stats(reader);
    const std::size_t count = reader.get_count(kLeastUnitBytes);
    result.units.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        result.units.push_back(read_unit_result(reader, result.pass));
    result.evidence = reader.get_array<std::uint8_t>();
    result.splats = reader.get_array<std::uint8_t>();
    return result;
}

}  // namespace treefarm
