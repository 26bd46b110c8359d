// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "common/runs/pass_figures.h"

namespace treefarm {

/// Files that have a key, as bits beside those of figures.
inline constexpr unsigned kInStatus = 8;  ///< status.json
inline constexpr unsigned kInLife = 16;   ///< launch/status.json
inline constexpr unsigned kInStudy = 32;  ///< study.json, for the keys that are read
inline constexpr unsigned kInBoth = kInSummary | kInStatus;

/// A key of a JSON file of a run directory.
struct RunKeyRow {
    const char* path;  ///< keys from the outermost on, separated by dots; of a list, those of its elements
    const char* unit;
    unsigned places;
    const char* meaning;
};

/// Keys of status.json, summary.json and cell.json. In summary.json a missing figure is null.
inline constexpr RunKeyRow kRunKeys[] = {
    {"state", "word", kInBoth, "running, done, interrupted or failed"},
    {"attempt", "word", kInBoth | kInLife, "attempt of treefarm launch that it is"},
    {"version", "word", kInSummary, "version of the program"},
    {"command", "text", kInSummary, "command that started the run"},
    {"scene", "path", kInSummary, "scene file"},
    {"scene_hash", "hash", kInSummary, "hash of the scene as it was packed"},
    {"fingerprint", "hash", kInSummary, "hash of the build: equal ones give equal images"},
    {"build", "object", kInSummary, "what is in the fingerprint"},
    {"build.source", "word", kInSummary, "commit, as git describes it"},
    {"build.options", "text", kInSummary, "options of the build"},
    {"build.compiler", "text", kInSummary, "compiler"},
    {"build.embree", "word", kInSummary, "version of Embree"},
    {"build.program", "hash", kInSummary, "hash of the program's bytes"},
    {"host", "word", kInBoth | kInLife, "the coordinator's host"},
    {"processor", "text", kInSummary, "its processor"},
    {"started", "UTC", kInSummary, "begin of the run, to the minute"},
    {"width", "pixels", kInSummary | kInCell, "width of the image"},
    {"height", "pixels", kInSummary | kInCell, "height of the image"},
    {"crop", "object", kInSummary, "crop window on the whole film; null: none"},
    {"crop.x", "pixels", kInSummary, "its left edge"},
    {"crop.y", "pixels", kInSummary, "its upper edge"},
    {"crop.film_width", "pixels", kInSummary, "width of the film"},
    {"crop.film_height", "pixels", kInSummary, "height of the film"},
    {"pass", "number", kInStatus, "pass in work, from 1"},
    {"passes", "list", kInBoth | kInCell, "summary.json, cell.json: the finished passes; status.json: their count"},
    {"spp_done", "samples/pixel", kInStatus, "samples of the finished passes"},
    {"spp", "samples/pixel", kInBoth, "summary.json: samples of the image; status.json: expected in all"},
    {"fraction", "fraction", kInStatus, "samples done, of those expected"},
    {"seconds", "s", kInSummary, "duration of the run"},
    {"elapsed_seconds", "s", kInStatus, "since the run began"},
    {"seconds_left", "s", kInStatus, "expected time until the end"},
    {"run_seconds", "s", kInStatus, "since the first worker asked for work"},
    {"workers", "count", kInStatus, "workers that take part"},
    {"rays", "count", kInStatus, "rays traced"},
    {"image_hash", "hash", kInSummary, "hash of the pixels"},
    {"aov_hash", "hash", kInSummary, "hash of the other layers"},
    {"tree_hash", "hash", kInSummary, "hash of the guiding tree"},
    {"tree_file_hash", "hash", kInSummary, "hash of tree.bin; empty: there is none"},
    {"image_error", "object", kInBoth, "estimated error of the image; null: not known"},
    {"image_error.relative", "ratio", kInBoth, "RMSE over mean luminance"},
    {"image_error.low", "ratio", kInBoth, "lower end of its 95 % interval"},
    {"image_error.high", "ratio", kInBoth, "upper end of its 95 % interval"},
    {"image_error.rmse", "radiance", kInBoth, "RMSE over pixels and channels"},
    {"image_error.rmse_low", "radiance", kInBoth, "lower end of its 95 % interval"},
    {"image_error.rmse_high", "radiance", kInBoth, "upper end of its 95 % interval"},
    {"image_error.mean", "luminance", kInBoth, "mean luminance"},
    {"halving", "object", kInBoth, "forecast until half of the error"},
    {"halving.relative_error", "ratio", kInBoth, "error that it is about"},
    {"halving.spp", "samples/pixel", kInBoth, "samples until then; null: not known"},
    {"halving.seconds", "s", kInBoth, "time until then; null: not known"},
    {"halving.trust", "word", kInBoth, "firm, noisy, learning (an upper bound), or empty"},
    {"target", "object", kInBoth, "status.json: forecast until budget.error, as halving; summary.json: the outcome"},
    {"target.relative_error", "ratio", kInBoth, "budget.error"},
    {"target.spp", "samples/pixel", kInStatus, "samples until then"},
    {"target.seconds", "s", kInStatus, "time until then"},
    {"target.trust", "word", kInStatus, "as halving.trust"},
    {"target.reached", "boolean", kInSummary, "the error is at most budget.error"},
    {"pass_weights", "list", kInSummary, "weight of each pass in the image"},
    {"tail_share", "fraction", kInSummary, "smallest share of the pixels with 40 % of the noise"},
    {"tail_origin", "text", kInSummary, "origin of most of the noise of tail_worst"},
    {"tail_worst", "list", kInSummary, "the worst samples"},
    {"tail_worst.pass", "number", kInSummary, "pass, as --debug-sample takes it"},
    {"tail_worst.x", "pixels", kInSummary, "column of the pixel"},
    {"tail_worst.y", "pixels", kInSummary, "row of the pixel"},
    {"tail_worst.sample", "number", kInSummary, "sample of the pixel"},
    {"tail_worst.noise", "luminance^2", kInSummary, "variance that the sample adds to its pixel"},
    {"tail_worst.vertices", "count", kInSummary, "vertices of its path"},
    {"tail_worst.origin", "text", kInSummary, "origin of its light"},
    {"error", "text", kInSummary, "reason of a failure"},
    {"approximations", "list", kInSummary, "approximations of the scene, in words"},
    {"farm", "object", kInBoth, "workers and work units"},
    {"farm.workers", "list", kInBoth, "workers"},
    {"farm.workers.worker", "number", kInBoth, "number of the worker"},
    {"farm.workers.host", "word", kInBoth, "its host"},
    {"farm.workers.threads", "count", kInBoth, "its threads"},
    {"farm.workers.state", "word", kInBoth, "present, lost, refused, left or barred"},
    {"farm.workers.losses", "count", kInBoth, "processes of it that ended while they were needed"},
    {"farm.workers.paths_per_second", "1/s", kInBoth, "its speed"},
    {"farm.workers.rays", "count", kInBoth, "rays it traced"},
    {"farm.workers.idle_share", "fraction", kInBoth, "of the last pass in which its threads waited for units"},
    {"farm.workers.processor_share", "fraction", kInBoth, "of their processors' time that its busy threads got then"},
    {"farm.workers.bad_messages", "count", kInBoth, "its messages that were refused"},
    {"farm.reissued_units", "count", kInBoth, "work units of lost workers, issued again"},
    {"farm.copied_units", "count", kInBoth, "work units given to a second worker"},
    {"farm.dropped_results", "count", kInBoth, "results that came too late to count"},
    {"farm.bad_messages", "count", kInBoth, "messages that were refused"},
    {"pid", "number", kInStatus, "process of the coordinator"},
    {"time", "Unix s", kInStatus, "time of this writing"},
    {"phase", "word", kInLife, "what the coordinator does"},
    {"code", "number", kInLife, "exit code, once it is known"},
    {"study", "path", kInStudy, "file that the study was read from"},
    {"flip", "number", kInCell, "mean FLIP of the image against the reference"},
    {"passes.measured", "object", kInCell, "true errors of the pass against the reference"},
};

/// A key of a run's files, or a figure of a pass; other names do not compile.
class RunKey {
  public:
    consteval RunKey(const char* name) : name_(name) {
        if (!is_known(name)) throw "no file of a run has this key";
    }
    constexpr RunKey(const PassFigure& figure) : name_(figure.name) {}
    constexpr const char* name() const { return name_; }

  private:
    static consteval bool is_known(std::string_view name) {
        for (const PassFigure& figure : kPassFigures)
            if (name == figure.name) return true;
        for (const RunKeyRow& row : kRunKeys) {
            const std::string_view path = row.path;
            if (path.substr(path.rfind('.') + 1) == name) return true;  // npos + 1 is 0
        }
        return false;
    }
    const char* name_;
};

}  // namespace treefarm
