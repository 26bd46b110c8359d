// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>
#include <vector>

#include "cli/usage.h"
#include "common/config/job_keys.h"

namespace treefarm {

namespace {

/// Options of other renderers, with their equivalents here.
struct Foreign {
    std::vector<std::string_view> options;
    const char* advice;
};

const std::vector<Foreign>& foreign_options() {
    static const std::vector<Foreign> table = {
        {{"--resume", "--continue", "--restart", "--checkpoint"},
         "treefarm resume RUN_DIR goes on with a render, as treefarm render ... --run-dir RUN_DIR --resume does; "
         "treefarm study goes on where it was"},
        {{"--denoise", "--denoiser", "--denoising", "--oidn"},
         "there is no denoiser in this version; image.exr holds what one needs of noise (variance.*, halfA.*, "
         "halfB.*)"},
        {{"--crop", "--cropwindow", "--pixelbounds", "--region", "--border"},
         "the scene's film says it: crop_offset_x, crop_offset_y, crop_width, crop_height; write $name there and "
         "choose "
         "with -D name=value"},
        {{"--camera", "--view"}, "write --sensor N, or its id"},
        {{"--frame", "--frame-start", "--frame-end", "--frame-jump", "--frameRange", "--animation"},
         "write --frames 1-24 -D name=%d, with $name in the scene"},
        {{"--output-format", "--format", "--render-format", "--file-format"},
         "-o writes an EXR; preview.png is in the run directory"},
        {{"--resolution", "--res", "--size", "--film-size"}, "write --set image.width=N --set image.height=N"},
        {{"--samples", "--sample-count", "--samples-per-pixel", "--num-samples", "--pixelsamples"}, "write --spp N"},
        {{"--time", "--time-limit", "--timelimit", "--timeout", "--halttime", "--duration"}, "write --seconds N"},
        {{"--noise", "--noise-threshold", "--noise-level", "--target-error", "--quality"}, "write --error 5%"},
        {{"--nthreads", "--num-threads", "--jobs", "--cores", "-j", "-t"}, "write --threads N"},
        {{"--output-dir", "--outdir", "--out-dir", "--render-output"}, "write --run-dir FOLDER"},
        {{"--outfile", "--out", "--output-file"}, "write -o FILE.exr"},
        {{"--define"}, "write -D name=value"},
        {{"--gpu", "--device", "--cycles-device", "--cuda", "--optix"}, "it renders on processors only"},
        {{"--aov", "--aovs", "--passes", "--layers"},
         "write --set output.aovs=albedo,normal,depth; treefarm keys output.aovs lists the layers"},
        {{"--integrator", "--estimator", "--renderer"},
         "write --set integrator.type=NAME; treefarm keys integrator.type lists them"},
        {{"--guiding", "--guide"}, "write --set guiding.type=NAME; treefarm keys guiding.type lists them"},
        {{"--exposure", "--tonemap", "--tone-map", "--gamma", "--colorspace"},
         "image.exr is linear, for a viewer to show; preview.png has exposure 0 and sRGB"},
        {{"--spectral", "--mode", "--variant", "-m"}, "it renders linear sRGB colours only"},
        {{"--hosts", "--hostfile", "--nodes", "--workers", "--ranks", "-n", "-np"},
         "treefarm launch takes it: treefarm launch -n 9 -- render ... has one coordinator and eight workers"},
    };
    return table;
}

/// Whether an option is a job key, or the last part of one: "--guiding.type", "--max-depth".
bool names_key(const std::string& option, const std::string& key) {
    std::string name = option.substr(std::min(option.find_first_not_of('-'), option.size()));
    std::replace(name.begin(), name.end(), '-', '_');
    return !name.empty() && (key == name || key.ends_with("." + name));
}

}  // namespace

std::string option_advice(const std::string& option, const std::string& command) {
    if (command != "render" && command != "plan") return "";
    for (const Foreign& foreign : foreign_options())
        if (std::find(foreign.options.begin(), foreign.options.end(), option) != foreign.options.end())
            return foreign.advice;
    for (const JobKey& key : job_keys())
        if (names_key(option, key.name)) return "it is a key of the job: write --set " + key.name + "=VALUE";
    const std::string section = option.substr(std::min(option.find_first_not_of('-'), option.size()));
    const auto is_in_section = [&](const JobKey& key) { return key.name.starts_with(section + "."); };
    if (std::any_of(job_keys().begin(), job_keys().end(), is_in_section))
        return "it is a table of keys: treefarm keys " + section + ". lists them, and --set " + section +
               ".KEY=VALUE sets one";
    return "";
}

}  // namespace treefarm
