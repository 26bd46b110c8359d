// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/files/atomic_file.h"
#include "common/config/job.h"
#include "common/image/exr.h"
#include "common/plan/effects/effects.h"
#include "common/runs/run_files.h"
#include "coordinator/passes/pass_loop.h"
#include "coordinator/run/file_writer.h"
#include "coordinator/run/last_files.h"
#include "coordinator/run/run_checkpoints.h"
#include "coordinator/run/run_folder.h"
#include "coordinator/run/run_report.h"

namespace treefarm {

/// Options of opening a run directory.
struct RunDirectoryOptions {
    FolderUse use = FolderUse::fresh;
    std::function<bool()> interrupted;          ///< ends the wait for a folder in use; may be empty
    const LoadedCheckpoint* resumed = nullptr;  ///< checkpoint being resumed
};

/// Folder of one run: job.toml, plan.txt, plan.json, log.txt, status.json, passes.csv, schedule.toml, image.exr,
/// preview.png, tree.bin, summary.json, checkpoint/. Every file is replaced as a whole or appended to by lines, so that
/// a reader never sees an incomplete one. Files are written in the background during the render, and a failed write
/// does not end it; a folder that vanished is made again.
class RunDirectory {
  public:
    /// Makes the folder and writes the files known before the render; a resumed run writes only status.json. Throws
    /// InputError on failure; RunError if the disk is full or out of reach.
    RunDirectory(const Job& job, RunFacts facts, const EffectPlan& plan, const RunDirectoryOptions& options = {});

    const std::filesystem::path& path() const { return folder_.path(); }
    std::filesystem::path log_file() const { return path() / kLogFile; }
    std::size_t passes() const { return passes_.size(); }  ///< number of finished passes

    /// Writes the files known before the render. They replace those of a resumed run, so call this only once the
    /// render continues. Throws as the constructor.
    void write_request();

    /// Writes status.json, at most once a second. `farm`: source of the workers' figures, or nullptr.
    void write_status(const RenderProgress& progress, double elapsed_seconds, const Farm* farm = nullptr);
    /// Writes preview.png, at most once a second and in at most half a percent of the time: the finished passes, and
    /// the results so far of the present one.
    void write_preview(std::span<const PixelEstimate> film, int width, int height, double elapsed_seconds);
    /// Adds a line to passes.csv and a table to schedule.toml.
    void add_pass(const PassReport& report);
    /// Writes image.exr of the passes so far.
    void write_image(const RenderResult& result);
    bool checkpoint_is_due(double elapsed_seconds) const { return checkpoints_.is_due(elapsed_seconds); }
    /// Writes a checkpoint if one is due; called after each pass, and within one by checkpoint_is_due().
    void offer_checkpoint(RenderState& state, double elapsed_seconds) { checkpoints_.offer(state, elapsed_seconds); }
    /// Stores the run's final state for the checkpoint that finish() writes.
    void take_last_state(RenderState state) { checkpoints_.take_last(std::move(state)); }
    /// File errors since the last call, for the user.
    std::vector<std::string> take_news();

    /// Writes summary.json and status.json of an interrupted run, if its image is on disk: finish() may come too late,
    /// since mpirun kills its ranks two seconds after a signal.
    void write_interruption(const RenderResult& result, const Farm* farm, double elapsed_seconds);

    /// Writes the final files: image.exr, the job's output.file, tree.bin (the result's encoded tree) if one was
    /// learned, preview.png, passes.csv, schedule.toml, summary.json and the last status.json, each independently and
    /// with retries for some seconds. `end`: result of the run; it becomes failed if files cannot be written, which are
    /// returned with the reasons.
    std::vector<std::string> finish(const RenderResult& result, const Farm* farm, RunEnd& end);

    /// Ends a resumed run that has no results of its own: the earlier files stay, and status.json has the new state.
    void leave(RunState state, std::uint32_t spp, double elapsed_seconds);

    /// Whether an earlier run is set aside in the folder.
    bool has_previous() const { return folder_.has_previous(); }
    /// Restores the folder as it was found, for a run without results.
    void give_back();

  private:
    void note_pass(const PassReport& report);
    CheckpointOrigin origin_of_checkpoints() const;
    void write_first(const std::function<void()>& write) const;
    void write_request_files() const;
    void write_bytes(const std::string& name, std::span<const std::uint8_t> bytes, Outlives outlives) const;
    void write_text(const std::string& name, const std::string& text, Outlives outlives) const;
    void put_text(const std::string& name, std::string text, Pace pace);
    Attributes image_attributes(const RenderResult& result) const;
    std::vector<LastFile> last_files(const RenderResult& result, Outlives outlives, RunEnd& end);
    std::vector<LastFile> end_files(const RenderResult& result, const Farm* farm, const RunEnd& end,
                                    Outlives outlives) const;
    bool image_is_on_disk(const RenderResult& result) const;

    const Job job_;
    const std::string job_toml_;  ///< without its output, so that a repeated run does not replace it
    const Job::Output storage_;   ///< of the resolved job: storage formats of image.exr
    const RunFacts facts_;
    const std::string resolved_toml_;
    RunFolder folder_;
    const std::string plan_text_, plan_json_;
    std::string passes_csv_;
    std::vector<PassPlan> passes_;         ///< the finished ones
    std::optional<PassReport> last_pass_;  ///< since the start or resume
    double last_status_ = -1e9;
    double next_preview_ = 0;
    std::shared_ptr<const CombinedImage> newest_ = std::make_shared<CombinedImage>();  ///< for previews
    std::uint32_t newest_spp_ = 0;
    std::atomic<double> preview_seconds_ = 0;  ///< core-seconds that the writer needed for the last one
    RunCheckpoints checkpoints_;
    mutable std::mutex on_disk_mutex_;
    std::weak_ptr<const CombinedImage> on_disk_;  ///< image that image.exr holds completely
    FileWriter writer_;                           ///< last: destroyed first
};

}  // namespace treefarm
