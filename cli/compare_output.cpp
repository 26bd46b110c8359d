// SPDX-License-Identifier: Apache-2.0
#include "cli/compare_output.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

namespace treefarm {

namespace {

std::string number(double value) {
    if (std::isnan(value)) return "undefined";
    std::ostringstream text;
    text << std::setprecision(6) << value;
    return text.str();
}

void row(std::ostream& out, const char* name, const std::string& value, const char* note = "") {
    out << "  " << std::left << std::setw(24) << name << value;
    if (*note != '\0') out << std::string(value.size() < 14 ? 14 - value.size() : 1, ' ') << note;
    out << '\n';
}

const char* verdict(bool pass) {
    return pass ? "pass" : "FAIL";
}

void print_errors(const ErrorMetrics& m, std::ostream& out) {
    row(out, "pixels", std::to_string(m.pixels));
    row(out, "compared", std::to_string(m.compared), "finite in both");
    row(out, "NaN/Inf in image", std::to_string(m.invalid_image));
    row(out, "NaN/Inf in reference", std::to_string(m.invalid_reference));
    if (m.negative_image > 0) row(out, "negative in image", std::to_string(m.negative_image));
    if (m.negative_reference > 0) row(out, "negative in reference", std::to_string(m.negative_reference));
    row(out, "RMSE", number(m.rmse));
    row(out, "MSE", number(m.mse));
    row(out, "relMSE", number(m.rel_mse));
    const std::string trimmed = "without the worst " + std::to_string(m.trimmed) + " pixels (0.1 %)";
    row(out, "relMSE trimmed", number(m.rel_mse_trimmed), trimmed.c_str());
    row(out, "MAPE", number(m.mape));
    row(out, "SMAPE", number(m.smape));
    row(out, "outliers", std::to_string(m.outliers),
        ("relative squared error above " + number(m.outlier_limit)).c_str());
    if (m.compared > 0)
        row(out, "worst pixel", number(m.worst),
            ("at (" + std::to_string(m.worst_x) + ", " + std::to_string(m.worst_y) + ")").c_str());
    row(out, "mean luminance", number(m.mean_image), ("reference " + number(m.mean_reference)).c_str());
    row(out, "mean ratio", number(m.mean_ratio), "image / reference");
    row(out, "mean ratio trimmed", number(m.mean_ratio_trimmed), "without the same pixels");
    row(out, "mean ratio R, G, B",
        number(m.channel_ratio[0]) + ", " + number(m.channel_ratio[1]) + ", " + number(m.channel_ratio[2]));
    row(out, "median block ratio", number(m.block_ratio_median), "of luminance");
}

void print_flip(const FlipMetrics& m, std::ostream& out) {
    row(out, "FLIP", number(m.hdr.mean),
        ("HDR, " + std::to_string(m.exposures.count) + " exposures from " + number(m.exposures.start) + " to " +
         number(m.exposures.stop) + " stops, " + number(m.ppd) + " pixels per degree")
            .c_str());
    row(out, "FLIP weighted median", number(m.hdr.weighted_median));
    row(out, "FLIP max", number(m.hdr.max));
    row(out, "FLIP of [0, 1]", number(m.ldr.mean), "without tone curve, clamped");
}

void print_z_tests(const Comparison& c, std::ostream& out) {
    if (!c.z_unavailable.empty()) {
        row(out, "z-tests", "not available: " + c.z_unavailable);
        return;
    }
    const PixelZTest& p = c.pixel_test;
    const BlockZTest& b = c.block_test;
    row(out, "noise of the reference", c.reference_noise);
    row(out, "z-test of pixels", verdict(p.pass),
        (std::to_string(p.accepted) + " of " + std::to_string(p.tests) + " accept (|z| <= " + number(p.limit) + "), " +
         number(100.0 * c.z_options.accepted_share) + " % must")
            .c_str());
    row(out, "", "", ("max |z| " + number(p.max_abs_z) + ", mean z^2 " + number(p.mean_z2)).c_str());
    if (p.invalid > 0) row(out, "", "", (std::to_string(p.invalid) + " pixels left out of both tests").c_str());
    row(out, "z-test of blocks", verdict(b.pass),
        ("max |z| " + number(b.max_abs_z) + " in the block at (" + std::to_string(b.worst_x) + ", " +
         std::to_string(b.worst_y) + "), limit " + number(b.limit))
            .c_str());
    row(out, "", "",
        (std::to_string(b.tests) + " tests of " + std::to_string(c.z_options.block) + " x " +
         std::to_string(c.z_options.block) + " pixels: " + std::to_string(b.beyond_3) + " beyond 3, " +
         std::to_string(b.beyond_4) + " beyond 4, mean z^2 " + number(b.mean_z2))
            .c_str());
    row(out, "z of the whole image", number(b.image_z[0]) + ", " + number(b.image_z[1]) + ", " + number(b.image_z[2]),
        "R, G, B");
}

using Json = nlohmann::ordered_json;

Json figures_json(const FlipFigures& f) {
    return {{"mean", f.mean}, {"weighted_median", f.weighted_median}, {"max", f.max}};
}

Json flip_json(const FlipMetrics& m) {
    Json json = {{"pixels_per_degree", m.ppd}, {"hdr", figures_json(m.hdr)}, {"ldr", figures_json(m.ldr)}};
    json["hdr"]["start_exposure"] = m.exposures.start;
    json["hdr"]["stop_exposure"] = m.exposures.stop;
    json["hdr"]["exposures"] = m.exposures.count;
    return json;
}

Json z_tests_json(const Comparison& c) {
    if (!c.z_unavailable.empty()) return {{"available", false}, {"reason", c.z_unavailable}};
    const PixelZTest& p = c.pixel_test;
    const BlockZTest& b = c.block_test;
    Json json = {{"available", true},
                 {"significance", c.z_options.significance},
                 {"reference_noise", c.reference_noise},
                 {"pixels_left_out", p.invalid}};
    json["pixels"] = {{"pass", p.pass},
                      {"tests", p.tests},
                      {"accepted", p.accepted},
                      {"accepted_share", p.accepted_share},
                      {"required_share", c.z_options.accepted_share},
                      {"limit", p.limit},
                      {"max_abs_z", p.max_abs_z},
                      {"mean_z2", p.mean_z2},
                      {"variance_floor", c.z_options.variance_floor}};
    json["blocks"] = {{"pass", b.pass},           {"block", c.z_options.block},
                      {"tests", b.tests},         {"beyond_3", b.beyond_3},
                      {"beyond_4", b.beyond_4},   {"mean_z2", b.mean_z2},
                      {"max_abs_z", b.max_abs_z}, {"worst_block", {b.worst_x, b.worst_y}},
                      {"limit", b.limit}};
    json["image_z"] = b.image_z;
    return json;
}

}  // namespace

void print_table(const Comparison& comparison, std::ostream& out) {
    out << comparison.image << " against " << comparison.reference << " (" << comparison.width << " x "
        << comparison.height << ")\n";
    print_errors(comparison.errors, out);
    print_flip(comparison.flip, out);
    print_z_tests(comparison, out);
}

void print_json(const Comparison& comparison, std::ostream& out) {
    const ErrorMetrics& m = comparison.errors;
    Json json = {{"image", comparison.image},
                 {"reference", comparison.reference},
                 {"width", comparison.width},
                 {"height", comparison.height},
                 {"image_spp", comparison.image_spp ? Json(*comparison.image_spp) : Json(nullptr)}};
    json["pixels"] = {{"total", m.pixels},
                      {"compared", m.compared},
                      {"invalid_image", m.invalid_image},
                      {"invalid_reference", m.invalid_reference},
                      {"negative_image", m.negative_image},
                      {"negative_reference", m.negative_reference}};
    json["rmse"] = m.rmse;
    json["mse"] = m.mse;
    json["rel_mse"] = m.rel_mse;
    json["rel_mse_trimmed"] = m.rel_mse_trimmed;
    json["trimmed_pixels"] = m.trimmed;
    json["mape"] = m.mape;
    json["smape"] = m.smape;
    json["outliers"] = {{"count", m.outliers}, {"limit", m.outlier_limit}};
    json["worst_pixel"] = nullptr;
    if (m.compared > 0) json["worst_pixel"] = {{"x", m.worst_x}, {"y", m.worst_y}, {"relative_squared_error", m.worst}};
    json["mean_luminance"] = {{"image", m.mean_image}, {"reference", m.mean_reference}};
    json["mean_ratio"] = m.mean_ratio;
    json["mean_ratio_trimmed"] = m.mean_ratio_trimmed;
    json["channel_ratio"] = m.channel_ratio;
    json["block_ratio_median"] = m.block_ratio_median;
    json["flip"] = flip_json(comparison.flip);
    json["z_tests"] = z_tests_json(comparison);
    // Paths need not be UTF-8.
    out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace treefarm
