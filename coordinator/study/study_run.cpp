// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study_run.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/files/atomic_file.h"
#include "common/base/text/duration_text.h"
#include "common/base/text/parse_text.h"
#include "common/image/exr.h"
#include "common/runs/run_json.h"
#include "coordinator/farm/pulse.h"
#include "coordinator/run/folder_lock.h"
#include "coordinator/run/result_image.h"
#include "coordinator/study/cell_record.h"
#include "coordinator/study/cell_request.h"
#include "coordinator/study/reference.h"
#include "coordinator/study/study_rules.h"
#include "coordinator/words/reading_notice.h"
#include "coordinator/words/series_progress.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Failing cells in a row after which the study ends: they are no accident.
constexpr int kMostFailures = 3;

/// Seconds within which a killed study has left its folder.
constexpr double kStudyPatience = 5.0;

struct Interrupted {};

/// Number with noun: "1 scene", "2 scenes".
std::string counted(std::size_t number, const std::string& what) {
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

class StudyRun {
  public:
    StudyRun(const Study& study, const SeriesContext& context)
        : pulse_(*context.workers.channel),
          study_(study),
          context_(context),
          log_(context.log),
          interrupted_(context.workers.stop),
          directory_(study.directory),
          cells_(study_cells(study)),
          progress_("cell", cells_.size()),
          series_(context) {}

    StudyOutcome run() {
        fs::create_directories(directory_);
        const FolderLock lock(directory_, kStudyPatience, interrupted_);
        if (lock.refused())
            throw RunError(directory_.string() +
                           ": another study is at work in this folder; wait for it, or choose another by --dir");
        check_study_folder(directory_, study_, context_.overwrite);
        begin_description();
        log_->info("{}: {}, {}; results in {}", counted(cells_.size(), "cell"), counted(study_.scenes.size(), "scene"),
                   counted(study_.methods.size(), "method"), study_.directory);
        StudyOutcome outcome;
        try {
            for (std::size_t scene = 0; scene < study_.scenes.size(); ++scene)
                run_scene(scene);
            outcome.state = failures_ == 0 ? RunState::done : RunState::failed;
        } catch (const Interrupted&) {
            log_->warn("interrupted: the same command goes on from here");
            outcome.state = RunState::interrupted;
        }
        outcome.lost_peers = series_.lost_peers();
        fs::remove_all(directory_ / "warmup");
        return outcome;
    }

  private:
    void begin_description() {
        description_ = {{"study", study_.file}, {"command", context_.origin.command}, {"baseline", study_.baseline}};
        for (const Setting& setting : study_.budgets)
            description_["budget"][setting.key].push_back(setting.value);
        description_["scenes"] = Json::array();
        for (const StudyScene& scene : study_.scenes)
            description_["scenes"].push_back({{"name", scene.name}, {"file", scene.file}});
        description_["methods"] = Json::array();
        for (const StudyMethod& method : study_.methods) {
            Json settings = Json::object();
            for (const Setting& setting : method.settings)
                settings[setting.key] = setting.value;
            description_["methods"].push_back({{"name", method.name}, {"settings", settings}});
        }
        description_["cells"] = Json::array();
    }

    void write_json(const fs::path& path, const Json& json) const {
        const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
        write_file_atomically(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }

    void run_scene(std::size_t scene) {
        const LoadedScene loaded = load(study_.scenes[scene]);
        Reference reference;
        RenderRequest reference_request;
        reference.key =
            reference_key(study_, study_.scenes[scene], loaded, reference, reference_request, context_.origin);
        std::vector<ReadyCell> ready;
        const auto make_ready = [&] {  // packs and hashes the scene for each
            for (const StudyCell& cell : cells_)
                if (cell.scene == scene) {
                    ready.push_back(ready_cell(study_, cell, loaded, reference.key, context_.origin));
                    describe(cell, ready.back());
                }
        };
        run_in_background(make_ready, [&] { pulse_.beat(); });
        prepare_reference(scene, reference, reference_request);
        description_["scenes"][scene]["reference"] = reference.about;
        write_json(directory_ / kStudyFile, description_);
        warm_up(scene, ready);
        std::size_t k = 0;
        for (const StudyCell& cell : cells_)
            if (cell.scene == scene) run_cell(cell, ready[k++], reference);
    }

    LoadedScene load(const StudyScene& scene) {
        const ReadingNotice notice(context_.console, scene.name);
        LoadedScene loaded;
        run_in_background([&] { loaded = load_study_scene(study_, scene); }, [&] { pulse_.beat(); });
        return loaded;
    }

    void describe(const StudyCell& cell, const ReadyCell& ready) {
        description_["cells"].push_back({{"folder", ready.folder.filename().string()},
                                         {"scene", study_.scenes[cell.scene].name},
                                         {"method", study_.methods[cell.method].name},
                                         {"seed", cell.seed},
                                         {"repetition", cell.repetition},
                                         {"budget", cell.budget}});
    }

    void prepare_reference(std::size_t scene, Reference& reference, RenderRequest& request) {
        const StudyScene& of = study_.scenes[scene];
        if (of.reference.empty()) {
            if (!reference.is_there()) {
                log_->info("{}: rendering the reference", of.name);
                const fs::path folder = fs::path(reference.file).parent_path();
                const auto frame = [&of](const RenderWords& w) {
                    return auxiliary_status("reference of " + of.name, w);
                };
                if (render(request, folder, frame).state != RunState::done)
                    throw RunError("the reference of " + of.name + " could not be rendered: see " +
                                   (folder / kLogFile).string());
            }
        }
        const ExrRgb image = read_exr_rgb(reference.file);
        reference.image = image.image;
        reference.about = {{"file", reference.file}, {"rendered", of.reference.empty()}};
        for (const char* name : {"error", "spp"})
            if (const auto at = image.attributes.find(std::string("treefarm.") + name); at != image.attributes.end())
                if (const auto value = parse_number(at->second)) reference.about[name] = *value;
        if (of.reference.empty()) write_json(reference.mark(), reference.about);
    }

    /// Renders in a folder of its own, after removing partial files of a killed run.
    RenderOutcome render(RenderRequest& request, const fs::path& folder, StatusFrame frame,
                         const decltype(RenderObserver::pass)& pass = {}) {
        if (interrupted_()) throw Interrupted();
        fs::remove_all(folder);
        request.storage.checkpoints = false;
        RenderOutcome outcome = series_.render(request, folder, std::move(frame), pass);
        if (outcome.state == RunState::interrupted) throw Interrupted();
        return outcome;
    }

    /// Renders once to warm up caches, clocks and the workers' memory.
    void warm_up(std::size_t scene, std::vector<ReadyCell>& ready) {
        const bool needed = std::any_of(ready.begin(), ready.end(), [](const ReadyCell& c) { return !c.done(); });
        const std::string name = "warm-up of " + study_.scenes[scene].name;
        for (int k = 0; needed && k < study_.warmup; ++k) {
            RenderRequest& request = ready[static_cast<std::size_t>(k) % ready.size()].request;
            render(request, directory_ / "warmup", [&name](const RenderWords& w) { return auxiliary_status(name, w); });
        }
    }

    void run_cell(const StudyCell& cell, ReadyCell& ready, const Reference& reference) {
        progress_.begin(cell_words(study_, cell));
        if (ready.done()) return;
        const Timer timer;
        std::vector<MeasuredPass> passes;
        const int width = reference.image.width, height = reference.image.height;
        const auto measure = [&](const PassReport& report, const CombinedImage& image) {
            passes.push_back({report, result_colours(image, width, height)});
        };
        const auto frame = [this](const RenderWords& words) { return progress_.status(words); };
        if (render(ready.request, ready.folder, frame, measure).state == RunState::failed) {
            log_->error("{}: failed, see {}", cell_words(study_, cell), (ready.folder / kLogFile).string());
            if (++failures_ >= kMostFailures)
                throw RunError("too many cells failed; the same command tries them again");
            return;
        }
        Json record;
        run_in_background([&] { record = render_record(passes, reference.image); }, [&] { pulse_.beat(); });
        tell(cell, record);
        write_json(ready.folder / kCellFile, record);
        progress_.end(timer.seconds());
    }

    void tell(const StudyCell& cell, const Json& record) const {
        const Json& last = record["passes"].back();
        log_->info(
            "{}", join_fields({progress_.position(), cell_words(study_, cell),
                               fmt::format("{} spp", last["spp_done"].get<int>()),
                               duration_text(last["run_seconds"].get<double>()),
                               fmt::format("error {:.3g} %", 100 * last["measured"]["rmse_over_mean"].get<double>())}));
    }

    Pulse pulse_;
    const Study& study_;
    const SeriesContext& context_;
    const Log log_;
    const std::function<bool()>& interrupted_;
    const fs::path directory_;
    const std::vector<StudyCell> cells_;
    Json description_;
    SeriesProgress progress_;
    RenderSeries series_;
    int failures_ = 0;
};

}  // namespace

StudyOutcome run_study(const Study& study, const SeriesContext& context) {
    return StudyRun(study, context).run();
}

}  // namespace treefarm
