#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "common/base/timer.h"
#include "common/config/job.h"
#include "common/image/atomic_file.h"
#include "common/plan/effects.h"
#include "common/protocol/fingerprint.h"
#include "coordinator/farm.h"
#include "coordinator/pass_loop.h"

namespace treefarm {

/// How a run ended.
enum class RunState : std::uint8_t { running, done, interrupted, failed };
const char* run_state_name(RunState state);

/// What a run is, for its files.
struct RunFacts {
    std::string command;  ///< that started it
    std::uint64_t scene_hash = 0;
    Fingerprint fingerprint;
};

/// The folder of one run: job.toml, plan.txt, plan.json, log.txt, status.json, passes.csv, schedule.toml, image.exr,
/// preview.png, tree.bin, summary.json. Every file is replaced as a whole or appended to by lines, so that a reader
/// never sees half of one. Throws RunError where a file cannot be written.
class RunDirectory {
  public:
    /// Makes the folder (runs/<scene>-<time> if the job names none) and writes job.toml, plan.txt and plan.json.
    RunDirectory(const Job& job, const RunFacts& facts, const EffectPlan& plan);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path log_file() const { return path_ / "log.txt"; }

    // What is written while workers wait for an answer does not wait for the disk (atomic_file.h).

    /// status.json, at most once a second.
    void write_status(const RenderProgress& progress, double elapsed_seconds);
    /// A line of passes.csv, a table of schedule.toml.
    void add_pass(const PassReport& report);
    /// image.exr, preview.png, and the job's output.file; tree.bin (encode_tree() of the result's tree) if there is one
    /// that learned.
    void write_image(const RenderResult& result);
    /// summary.json and the last status.json; passes.csv and schedule.toml once more, to outlive the machine's power.
    void write_summary(RunState state, const RenderResult& result, const Farm* farm, double elapsed_seconds,
                       const std::string& error);

  private:
    void write_text(const std::string& name, const std::string& text, Outlives outlives = Outlives::power) const;
    void write_passes(Outlives outlives) const;

    const Job job_;
    const RunFacts facts_;
    const std::vector<Approximation> approximations_;
    std::filesystem::path path_;
    std::string passes_csv_;
    std::string tree_file_hash_;    ///< of tree.bin; "" without one
    std::vector<PassPlan> passes_;  ///< the finished ones
    double last_status_ = -1e9;
};

}  // namespace treefarm
