// SPDX-License-Identifier: Apache-2.0
#include "serve/metrics_text.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <functional>
#include <utility>

#include "common/base/text/printable.h"

namespace treefarm {

namespace {

using Labels = std::vector<std::pair<const char*, std::string>>;

/// Escaped value of a label: backslash, quote and line end, as the format requires.
std::string escaped(const std::string& value) {
    std::string text;
    for (const char c : value) {
        if (c == '\\' || c == '"') text += '\\';
        if (c == '\n')
            text += "\\n";
        else
            text += c;
    }
    return text;
}

/// A metric: its header, then its samples.
class Metric {
  public:
    Metric(const char* name, const char* type, const char* help)
        : name_(name), text_(fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type)) {}

    void add(const Labels& labels, double value) {
        std::string list;
        for (const auto& [label, text] : labels)
            list += fmt::format("{}{}=\"{}\"", list.empty() ? "" : ",", label, escaped(text));
        text_ += fmt::format("{}{{{}}} {}\n", name_, list, value);
        empty_ = false;
    }
    /// Adds a sample, unless `value` is null.
    void add(const Labels& labels, const FileJson& value) {
        if (value.is_number()) add(labels, value.get<double>());
    }

    /// Text of the metric; empty without samples.
    std::string text() const { return empty_ ? "" : text_; }

  private:
    std::string name_, text_;
    bool empty_ = true;
};

struct Figure {
    const char *name, *type, *help, *key;
};

constexpr std::array kRunFigures = {
    Figure{"treefarm_run_progress_ratio", "gauge", "Fraction of the expected samples that is done.", "fraction"},
    Figure{"treefarm_run_elapsed_seconds", "gauge", "Time since the run began.", "elapsed_seconds"},
    Figure{"treefarm_run_left_seconds", "gauge", "Expected remaining time.", "seconds_left"},
    Figure{"treefarm_run_samples_per_pixel", "gauge", "Samples per pixel of finished passes.", "spp_done"},
    Figure{"treefarm_run_relative_error_ratio", "gauge", "RMSE of the image over its mean luminance, as estimated.",
           "error"},
    Figure{"treefarm_run_status_age_seconds", "gauge", "Time since the run last wrote its status.", "age_seconds"},
    Figure{"treefarm_run_workers", "gauge", "Workers that take part.", "workers"},
    Figure{"treefarm_run_rays_total", "counter", "Rays that were traced.", "rays"},
};
constexpr std::array kFarmFigures = {
    Figure{"treefarm_run_reissued_units_total", "counter", "Work units of lost workers that were issued again.",
           "reissued_units"},
    Figure{"treefarm_run_copied_units_total", "counter",
           "Work units given to a second worker since the first was slow.", "copied_units"},
    Figure{"treefarm_run_dropped_results_total", "counter", "Results that came too late to count.", "dropped_results"},
};
constexpr std::array kWorkerFigures = {
    Figure{"treefarm_worker_threads", "gauge", "Tracing threads of a worker.", "threads"},
    Figure{"treefarm_worker_paths_per_second", "gauge", "Speed of a worker: a mean over some seconds.",
           "paths_per_second"},
    Figure{"treefarm_worker_idle_ratio", "gauge",
           "Fraction of the last finished pass in which its threads waited for units.", "idle_share"},
    Figure{"treefarm_worker_processor_ratio", "gauge",
           "Fraction of their processors' time that its busy threads got in the last finished pass.",
           "processor_share"},
    Figure{"treefarm_worker_losses_total", "counter", "Losses of a worker while it was needed.", "losses"},
};
constexpr std::array kStates = {"running", "done", "interrupted", "failed", "killed", "silent", "unknown"};

/// A figure of a view; null where there is none.
FileJson number_at(const FileJson& view, const Figure& figure) {
    return view.is_object() ? view.value(figure.key, FileJson()) : FileJson();
}

std::string run_of(const FileJson& run) {
    const std::string path = run.value("run", "");
    return printable(path.empty() ? run.value("title", "") : path);
}

Labels labels_of(const FileJson& run, const FileJson& worker) {
    const FileJson number = number_of(worker, "worker"), host = text_of(worker, "host");
    return {{"run", run_of(run)},
            {"worker", number.is_number_integer() ? std::to_string(number.get<std::int64_t>()) : ""},
            {"host", host.is_string() ? printable(host.get<std::string>()) : ""}};
}

std::string worker_metric(const std::vector<FileJson>& runs, const Figure& figure,
                          const std::function<FileJson(const FileJson&)>& value) {
    Metric metric(figure.name, figure.type, figure.help);
    for (const FileJson& run : runs)
        for (const FileJson& worker : array_of(object_of(run, "farm"), "workers"))
            metric.add(labels_of(run, worker), value(worker));
    return metric.text();
}

}  // namespace

std::string metrics_text(const std::vector<FileJson>& runs) {
    Metric state("treefarm_run_state", "gauge", "1 for the state that a run is in, 0 for the others.");
    for (const FileJson& run : runs)
        for (const char* name : kStates)
            state.add({{"run", run_of(run)}, {"state", name}}, run.value("state", "") == name ? 1.0 : 0.0);
    std::string text = state.text();
    for (const Figure& figure : kRunFigures) {
        Metric metric(figure.name, figure.type, figure.help);
        for (const FileJson& run : runs)
            metric.add({{"run", run_of(run)}}, number_at(run, figure));
        text += metric.text();
    }
    for (const Figure& figure : kFarmFigures) {
        Metric metric(figure.name, figure.type, figure.help);
        for (const FileJson& run : runs)
            metric.add({{"run", run_of(run)}}, number_at(object_of(run, "farm"), figure));
        text += metric.text();
    }
    text += worker_metric(
        runs, {"treefarm_worker_up", "gauge", "1 while a worker takes part, else 0.", ""},
        [](const FileJson& worker) { return FileJson(worker.value("state", FileJson()) == "present" ? 1.0 : 0.0); });
    for (const Figure& figure : kWorkerFigures)
        text += worker_metric(runs, figure, [&](const FileJson& worker) { return number_at(worker, figure); });
    return text;
}

}  // namespace treefarm
