// SPDX-License-Identifier: Apache-2.0
#include "coordinator/shot/shot_run.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "common/base/files/atomic_file.h"
#include "common/base/text/duration_text.h"
#include "common/runs/run_files.h"
#include "coordinator/farm/pulse.h"
#include "coordinator/render/finished_render.h"
#include "coordinator/render/resume.h"
#include "coordinator/run/folder_content.h"
#include "coordinator/run/folder_lock.h"
#include "coordinator/run/last_files.h"
#include "coordinator/shot/frame_record.h"
#include "coordinator/shot/frames.h"
#include "coordinator/words/reading_notice.h"
#include "coordinator/words/series_progress.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Seconds within which a killed shot has left its folder.
constexpr double kShotPatience = 5.0;
/// Seconds for which the end retries writing the index.
constexpr double kIndexPatience = 1.0;

/// Throws InputError if a folder has other content.
void check_shot_folder(const fs::path& folder) {
    const auto refuse = [&](const std::string& what) {
        throw InputError(Location{folder.string(), 0, 0}, what, "name another folder with --run-dir");
    };
    switch (folder_content(folder)) {
        case FolderContent::nothing:
        case FolderContent::shot:
            return;
        case FolderContent::render:
            refuse("holds a render (" + render_words(folder) + "), which a shot does not replace");
            break;
        case FolderContent::study:
            refuse("holds a study, which a shot does not replace");
            break;
        case FolderContent::other:
            refuse("is no folder of a shot, but holds other files");
            break;
    }
}

class ShotRun {
  public:
    ShotRun(const Shot& shot, const SeriesContext& context)
        : pulse_(*context.workers.channel),
          shot_(shot),
          context_(context),
          log_(context.log),
          interrupted_(context.workers.stop),
          progress_("frame", shot.frames.size()),
          series_(context) {
        for (const int frame : shot.frames)
            records_.emplace_back().frame = frame;
    }

    ShotOutcome run() {
        make_folder(shot_.directory, "cannot be the shot's folder");
        const FolderLock lock(shot_.directory, kShotPatience, interrupted_);
        if (lock.refused())
            throw InputError(Location{shot_.directory.string(), 0, 0}, "another shot is at work in this folder",
                             "wait for it, or name another folder with --run-dir");
        check_shot_folder(shot_.directory);
        index_[0].write();  // now, not after the first frame
        log_->info("{} frames; results in {}", records_.size(), shot_.directory.string());
        for (FrameRecord& record : records_) {
            if (interrupted_()) break;
            run_frame(record);
            try_index();
            if (record.state == FrameState::interrupted) break;
            if (series_.has_lost_all()) {
                log_->error("no worker is left: start again, the frames that are done are kept");
                break;
            }
        }
        return end();
    }

  private:
    static void make_folder(const fs::path& folder, const char* what) {
        std::error_code error;
        fs::create_directories(folder, error);
        if (error)
            throw InputError(Location{folder.string(), 0, 0}, std::string(what) + ": " + error.message(),
                             "name another");
    }

    void write_index() const {
        const std::string text =
            shot_json(context_.origin.command, records_).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
            "\n";
        write_file_atomically(shot_.directory / kShotFile,
                              {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }

    /// Writes the index; a failed write is retried with the next frame.
    void try_index() {
        const bool was_written = index_[0].written;
        index_[0].written = false;
        if (!try_to_write(index_[0]) && was_written)
            log_->warn("{}; the shot goes on, and it is tried again with each frame", index_[0].failure);
    }

    void run_frame(FrameRecord& record) {
        progress_.begin(frame_digits(record.frame));
        try {
            render_frame(record);
        } catch (const std::bad_alloc&) {
            fail(record, "not enough memory to read the scene");
        } catch (const std::exception& error) {
            fail(record, error.what());
        }
    }

    void fail(FrameRecord& record, const std::string& message) const {
        record.state = FrameState::failed;
        record.message = message;
        log_->error("frame {}: {}", frame_digits(record.frame), message);
    }

    void render_frame(FrameRecord& record) {
        const Timer timer;
        const fs::path folder = shot_.directory / frame_folder(record.frame);
        RenderRequest request;
        bool is_there = false;
        {
            const ReadingNotice notice(context_.console, "frame " + frame_digits(record.frame));
            run_in_background(
                [&] {
                    request = shot_.read_request(record.frame);
                    is_there = holds_result_of(folder, request);
                    if (!is_there) go_on(folder, request);
                },
                [&] { pulse_.beat(); });
        }
        prepare_output(request.content.job.output.file, record.frame);
        if (is_there && restore_output(folder, request.content.job.output.file)) {
            take_figures(folder, request, record);
            record.state = FrameState::kept;
            tell(record);
            return;
        }
        tell_warnings(request);
        // An unfinished frame that cannot be resumed is started again; another request's result is replaced only on
        // request.
        request.storage.overwrite = context_.overwrite || is_there || !holds_result(folder);
        const RenderOutcome outcome =
            series_.render(request, folder, [this](const RenderWords& words) { return progress_.status(words); });
        take_figures(folder, request, record);
        switch (outcome.state) {
            case RunState::done:
                record.state = FrameState::done;
                progress_.end(timer.seconds());
                tell(record);
                return;
            case RunState::interrupted:
                record.state = FrameState::interrupted;
                return;
            default:
                fail(record, "see " + (folder / kLogFile).string());
        }
    }

    /// Resumes an unfinished frame.
    void go_on(const fs::path& folder, RenderRequest& request) const {
        if (holds_result(folder)) return;
        request.start.checkpoint = find_checkpoint(folder, request);
    }

    static void take_figures(const fs::path& folder, const RenderRequest& request, FrameRecord& record) {
        static_cast<RenderFigures&>(record) = read_figures(folder);
        if (!request.content.job.output.file.empty()) record.image = request.content.job.output.file;
    }

    /// Prepares a frame's output file; throws InputError if another frame has the same.
    void prepare_output(const std::string& file, int frame) {
        if (file.empty()) return;
        const auto [at, is_new] = outputs_.try_emplace(file, frame);
        if (!is_new)
            throw InputError(Location{file, 0, 0}, fmt::format("is the image of frame {} already", at->second),
                             "write #### where the frame's number belongs, as in frame.####.exr");
        if (const fs::path folder = fs::path(file).parent_path(); !folder.empty())
            make_folder(folder, "cannot be the folder of images");
    }

    /// Logs warnings of frames, each once: frames of one scene have the same.
    void tell_warnings(const RenderRequest& request) {
        for (const std::string& warning : request.content.warnings)
            if (told_.insert(warning).second) log_->warn("{}", warning);
    }

    void tell(const FrameRecord& record) const {
        log_->info("{}", join_fields({progress_.position(), frame_digits(record.frame),
                                      fmt::format("{} spp", record.spp), duration_text(record.seconds),
                                      record.error ? fmt::format("error {:.3g} %", 100 * *record.error) : "",
                                      record.state == FrameState::kept ? "kept: it was done before" : "",
                                      record.missed_target ? "above the error asked for" : ""}));
    }

    ShotOutcome end() {
        for (const std::string& failure : write_last_files(index_, kIndexPatience))
            log_->error("{}; the frames that are done are kept", failure);
        for (const std::string& line : frame_table(records_))
            log_->info("{}", line);
        const auto any = [&](auto... states) {
            return std::any_of(records_.begin(), records_.end(),
                               [&](const FrameRecord& record) { return ((record.state == states) || ...); });
        };
        ShotOutcome outcome;
        outcome.lost_peers = series_.lost_peers();
        outcome.missed_target = std::any_of(records_.begin(), records_.end(),
                                            [](const FrameRecord& record) { return record.missed_target; });
        const bool is_broken_off = interrupted_() || any(FrameState::interrupted);
        if (is_broken_off) {
            log_->warn("interrupted: the same command goes on from here");
            outcome.state = RunState::interrupted;
        } else {
            const bool failed = any(FrameState::failed, FrameState::waiting) || !index_[0].written;
            outcome.state = failed ? RunState::failed : RunState::done;
        }
        return outcome;
    }

    Pulse pulse_;
    const Shot& shot_;
    const SeriesContext& context_;
    const Log log_;
    const std::function<bool()>& interrupted_;
    std::vector<FrameRecord> records_;
    std::vector<LastFile> index_ = {{kShotFile, [this] { write_index(); }, "", true}};
    std::map<std::string, int> outputs_;
    std::set<std::string> told_;
    SeriesProgress progress_;
    RenderSeries series_;
};

}  // namespace

ShotOutcome run_shot(const Shot& shot, const SeriesContext& context) {
    return ShotRun(shot, context).run();
}

}  // namespace treefarm
