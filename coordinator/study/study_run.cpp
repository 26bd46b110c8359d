#include "coordinator/study/study_run.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/hash.h"
#include "common/config/parse_text.h"
#include "common/image/atomic_file.h"
#include "common/image/exr.h"
#include "coordinator/folder_lock.h"
#include "coordinator/result_image.h"
#include "coordinator/study/cell_record.h"
#include "coordinator/study/cell_request.h"
#include "coordinator/study/study_folder.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// So many cells in a row that fail are no accident.
constexpr int kMostFailures = 3;

/// A study that was killed has left its folder by then.
constexpr double kFolderPatience = 5.0;

struct Interrupted {};

/// What cells of a scene are measured against.
struct Reference {
    std::string file;
    std::string key;  ///< of its pixels or of what renders it
    RgbImage image;   ///< empty until it is needed
    Json about;

    /// One that was rendered is whole when this file stands beside it; an interrupted one has an image, too.
    fs::path mark() const { return fs::path(file).parent_path() / "reference.json"; }
};

std::string cell_words(const Study& study, const StudyCell& cell) {
    return study.scenes[cell.scene].name + "." + study.methods[cell.method].name + "." + std::to_string(cell.seed);
}

/// A cell's request with its folder.
struct ReadyCell {
    RenderRequest request;
    fs::path folder;
    bool done() const { return fs::exists(folder / "cell.json"); }
};

ReadyCell ready_cell(const Study& study, const StudyCell& cell, const LoadedScene& loaded,
                     const std::string& reference_key) {
    ReadyCell ready;
    ready.request = study_request(study, study.scenes[cell.scene], loaded, study.methods[cell.method].settings,
                                  cell_settings(study, cell));
    ready.folder = fs::path(study.directory) / "cells" /
                   folder_name(cell_words(study, cell), request_key(ready.request, reference_key));
    return ready;
}

/// Throws InputError unless cells of this film can be measured against it.
void check_given(const RgbImage& image, const Film& film, const Location& place) {
    if (image.width != film.width || image.height != film.height)
        throw InputError(place,
                         fmt::format("the reference has {} x {} pixels, the scene {} x {}", image.width, image.height,
                                     film.width, film.height),
                         "set image.width and image.height, or render another reference");
    const auto finite = [](const Rgb& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    const auto bad =
        image.pixels.size() - static_cast<std::size_t>(std::count_if(image.pixels.begin(), image.pixels.end(), finite));
    if (bad > 0)
        throw InputError(place, fmt::format("the reference has {} pixels that are no finite numbers", bad),
                         "render another reference");
}

/// A reference that is given, or the request that renders one.
std::string reference_key(const Study& study, const StudyScene& scene, const LoadedScene& loaded, Reference& reference,
                          RenderRequest& request) {
    if (!scene.reference.empty()) {
        const ExrRgb given = read_exr_rgb(scene.reference);
        check_given(given.image, loaded.scene.film, scene.reference_place);
        reference.file = scene.reference;
        reference.image = given.image;
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(given.image.pixels.data());
        return hash_text(hash_bytes({bytes, given.image.pixels.size() * sizeof(Rgb)}));
    }
    request = study_request(study, scene, loaded, study.reference.settings, {});
    const std::uint64_t key = request_key(request, "reference");
    reference.file = (fs::path(study.directory) / "references" / folder_name(scene.name, key) / "image.exr").string();
    return hash_text(key);
}

class StudyRun {
  public:
    StudyRun(Channel& channel, const Study& study, const std::string& command, bool overwrite, const Log& log,
             const std::function<bool()>& interrupted)
        : channel_(channel),
          study_(study),
          command_(command),
          overwrite_(overwrite),
          log_(log),
          interrupted_(interrupted),
          directory_(study.directory),
          cells_(study_cells(study)) {}

    StudyOutcome run() {
        fs::create_directories(directory_);
        const FolderLock lock(directory_, kFolderPatience, interrupted_);
        if (lock.refused())
            throw RunError(directory_.string() +
                           ": another study is at work in this folder; wait for it, or choose another by --dir");
        check_study_folder(directory_, study_, overwrite_);
        begin_description();
        StudyOutcome outcome;
        try {
            for (std::size_t scene = 0; scene < study_.scenes.size(); ++scene)
                run_scene(scene);
            outcome.state = failures_ == 0 ? RunState::done : RunState::failed;
        } catch (const Interrupted&) {
            log_->warn("interrupted: the same command goes on from here");
            outcome.state = RunState::interrupted;
        }
        outcome.lost_peers = turn_.absent;
        fs::remove_all(directory_ / "warmup");
        return outcome;
    }

  private:
    void begin_description() {
        description_ = {{"study", study_.file}, {"command", command_}, {"baseline", study_.baseline}};
        for (const Setting& setting : study_.budget)
            description_["budget"][setting.key] = setting.value;
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
        const LoadedScene loaded = load_study_scene(study_, study_.scenes[scene]);
        Reference reference;
        RenderRequest reference_request;
        reference.key = reference_key(study_, study_.scenes[scene], loaded, reference, reference_request);
        std::vector<ReadyCell> ready;
        for (const StudyCell& cell : cells_)
            if (cell.scene == scene) {
                ready.push_back(ready_cell(study_, cell, loaded, reference.key));
                describe(cell, ready.back());
            }
        prepare_reference(scene, reference, reference_request);
        description_["scenes"][scene]["reference"] = reference.about;
        write_json(directory_ / "study.json", description_);
        warm_up(ready);
        std::size_t k = 0;
        for (const StudyCell& cell : cells_)
            if (cell.scene == scene) run_cell(cell, ready[k++], reference);
    }

    void describe(const StudyCell& cell, const ReadyCell& ready) {
        description_["cells"].push_back({{"folder", ready.folder.filename().string()},
                                         {"scene", study_.scenes[cell.scene].name},
                                         {"method", study_.methods[cell.method].name},
                                         {"seed", cell.seed},
                                         {"repetition", cell.repetition}});
    }

    void prepare_reference(std::size_t scene, Reference& reference, RenderRequest& request) {
        const StudyScene& of = study_.scenes[scene];
        if (of.reference.empty()) {
            if (!fs::exists(reference.mark())) {
                log_->info("{}: rendering the reference", of.name);
                const fs::path folder = fs::path(reference.file).parent_path();
                if (render(request, folder).state != RunState::done)
                    throw RunError("the reference of " + of.name + " could not be rendered: see " +
                                   (folder / "log.txt").string());
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

    /// A run in a folder of its own. What a killed run left there goes first.
    RenderOutcome render(RenderRequest& request, const fs::path& folder) {
        if (interrupted_()) throw Interrupted();
        fs::remove_all(folder);
        request.job.output.directory = folder.string();
        request.command = command_;
        ++turn_.number;
        request.turn = turn_;
        const RenderOutcome outcome = run_render(channel_, request, interrupted_);
        turn_.absent = outcome.lost_peers;
        if (outcome.state == RunState::interrupted) throw Interrupted();
        return outcome;
    }

    /// Caches, clocks and the worker's memory are as they will be.
    void warm_up(std::vector<ReadyCell>& ready) {
        const bool needed = std::any_of(ready.begin(), ready.end(), [](const ReadyCell& c) { return !c.done(); });
        for (int k = 0; needed && k < study_.warmup; ++k)
            render(ready[static_cast<std::size_t>(k) % ready.size()].request, directory_ / "warmup");
    }

    void run_cell(const StudyCell& cell, ReadyCell& ready, const Reference& reference) {
        ++number_;
        if (ready.done()) return;
        std::vector<MeasuredPass> passes;
        const int width = reference.image.width, height = reference.image.height;
        ready.request.on_pass = [&](const PassReport& report, const CombinedImage& image) {
            passes.push_back({report, result_colours(image, width, height)});
        };
        const RenderOutcome outcome = render(ready.request, ready.folder);
        if (outcome.state == RunState::failed) {
            log_->error("{}: failed, see {}", cell_words(study_, cell), (ready.folder / "log.txt").string());
            if (++failures_ >= kMostFailures)
                throw RunError("too many cells failed; the same command tries them again");
            return;
        }
        Json record = render_record(passes, reference.image);
        tell(cell, record);
        write_json(ready.folder / "cell.json", record);
    }

    void tell(const StudyCell& cell, const Json& record) const {
        const Json& last = record["passes"].back();
        log_->info("cell {} of {}: {}: {} spp in {:.2f} s, RMSE {:.3g} % of the mean", number_, cells_.size(),
                   cell_words(study_, cell), last["spp_done"].get<int>(), last["run_seconds"].get<double>(),
                   100 * last["measured"]["rmse_over_mean"].get<double>());
    }

    Channel& channel_;
    const Study& study_;
    const std::string command_;
    const bool overwrite_;
    const Log log_;
    const std::function<bool()>& interrupted_;
    const fs::path directory_;
    const std::vector<StudyCell> cells_;
    Json description_;
    JobTurn turn_;
    std::size_t number_ = 0;
    int failures_ = 0;
};

}  // namespace

StudyOutcome run_study(Channel& channel, const Study& study, const std::string& command, bool overwrite, const Log& log,
                       const std::function<bool()>& interrupted) {
    return StudyRun(channel, study, command, overwrite, log, interrupted).run();
}

void list_cells(const Study& study, std::ostream& out) {
    std::size_t done = 0, number = 0;
    const std::vector<StudyCell> cells = study_cells(study);
    for (std::size_t scene = 0; scene < study.scenes.size(); ++scene) {
        const LoadedScene loaded = load_study_scene(study, study.scenes[scene]);
        Reference reference;
        RenderRequest request;
        const std::string key = reference_key(study, study.scenes[scene], loaded, reference, request);
        out << "reference of " << study.scenes[scene].name << ": " << reference.file
            << (!study.scenes[scene].reference.empty() || fs::exists(reference.mark()) ? " (there)\n"
                                                                                       : " (to be rendered)\n");
        for (const StudyCell& cell : cells) {
            if (cell.scene != scene) continue;
            const ReadyCell ready = ready_cell(study, cell, loaded, key);
            done += ready.done();
            out << "cell " << ++number << " of " << cells.size() << ": " << cell_words(study, cell)
                << (ready.done() ? " (done)\n" : "\n");
        }
    }
    out << done << " of " << cells.size() << " cells are done\n";
}

}  // namespace treefarm
