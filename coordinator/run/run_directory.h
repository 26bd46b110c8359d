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
#include "coordinator/passes/pass_loop.h"
#include "coordinator/run/file_writer.h"
#include "coordinator/run/last_files.h"
#include "coordinator/run/run_checkpoints.h"
#include "coordinator/run/run_folder.h"
#include "coordinator/run/run_report.h"

namespace treefarm {

/// How a run directory comes about.
struct RunDirectoryOptions {
    FolderUse use = FolderUse::fresh;
    std::function<bool()> interrupted;          ///< ends the wait for a folder that is in use; may be empty
    const LoadedCheckpoint* resumed = nullptr;  ///< what the run goes on from
};

/// The folder of one run: job.toml, plan.txt, plan.json, log.txt, status.json, passes.csv, schedule.toml, image.exr,
/// preview.png, tree.bin, summary.json, checkpoint/. Every file is replaced as a whole or appended to by lines, so that
/// a reader never sees half of one. While it renders all are written beside it, and none that cannot be written ends
/// it; a folder that vanished is made again.
class RunDirectory {
  public:
    /// Makes the folder and writes what is known before the render; of a run that goes on with another no more than
    /// status.json. Throws InputError where that cannot be.
    RunDirectory(const Job& job, RunFacts facts, const EffectPlan& plan, const RunDirectoryOptions& options = {});

    const std::filesystem::path& path() const { return folder_.path(); }
    std::filesystem::path log_file() const { return path() / "log.txt"; }
    std::size_t passes() const { return passes_.size(); }  ///< that are finished

    /// What is known before the render, in the place of what the run goes on from had: once it goes on. Throws as the
    /// constructor.
    void write_request();

    /// status.json, at most once a second. `farm`: its workers are told of; nullptr: they are not.
    void write_status(const RenderProgress& progress, double elapsed_seconds, const Farm* farm = nullptr);
    /// preview.png, at most once a second, and so seldom that it takes half a percent of the time: finished passes, and
    /// what has come of the pass in hand.
    void write_preview(std::span<const PixelEstimate> film, int width, int height, double elapsed_seconds);
    /// A line of passes.csv, a table of schedule.toml.
    void add_pass(const PassReport& report);
    /// image.exr of the passes so far.
    void write_image(const RenderResult& result);
    bool checkpoint_is_due(double elapsed_seconds) const { return checkpoints_.is_due(elapsed_seconds); }
    /// A checkpoint, where one is due; called after each pass, and within one by checkpoint_is_due().
    void offer_checkpoint(RenderState& state, double elapsed_seconds) { checkpoints_.offer(state, elapsed_seconds); }
    /// The state that the run ends in, for a checkpoint that finish() writes.
    void take_last_state(RenderState state) { checkpoints_.take_last(std::move(state)); }
    /// News of what went wrong with files since the last call, for a person.
    std::vector<std::string> take_news();

    /// summary.json and status.json of a run that was interrupted, if its image is on disk: finish() may come too late,
    /// since mpirun kills its ranks two seconds after a signal.
    void write_interruption(const RenderResult& result, const Farm* farm, double elapsed_seconds);

    /// Writes what a run leaves: image.exr, the job's output.file, tree.bin (the result's tree, encoded) if
    /// there is one that learned, preview.png, passes.csv, schedule.toml, summary.json and the last status.json, each
    /// on its own and tried again for some seconds. `end` says how the run ended; where files cannot be written it
    /// becomes failed, and they are returned, each with the reason.
    std::vector<std::string> finish(const RenderResult& result, const Farm* farm, RunEnd& end);

    /// Ends a run that went on with another and came to nothing: what that has left stays, status.json says how it
    /// ended.
    void leave(RunState state, std::uint32_t spp, double elapsed_seconds);

    /// Whether an earlier run lies aside in the folder.
    bool has_previous() const { return folder_.has_previous(); }
    /// Leaves the folder as it was found: nothing comes of this run.
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
    const std::string job_toml_;  ///< without its output: whoever repeats a run must not replace it
    const Job::Output storage_;   ///< of a resolved job: how image.exr holds its channels
    const RunFacts facts_;
    const std::string resolved_toml_;
    RunFolder folder_;
    const std::string plan_text_, plan_json_;
    std::string passes_csv_;
    std::vector<PassPlan> passes_;         ///< the finished ones
    std::optional<PassReport> last_pass_;  ///< of this life of the render
    double last_status_ = -1e9;
    double next_preview_ = 0;
    std::shared_ptr<const CombinedImage> newest_ = std::make_shared<CombinedImage>();  ///< for previews
    std::uint32_t newest_spp_ = 0;
    std::atomic<double> preview_seconds_ = 0;  ///< of a core, that the last one took the writer
    RunCheckpoints checkpoints_;
    mutable std::mutex on_disk_mutex_;
    std::weak_ptr<const CombinedImage> on_disk_;  ///< whose image.exr is whole
    FileWriter writer_;                           ///< last: it ends first
};

}  // namespace treefarm
