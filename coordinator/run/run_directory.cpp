// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/run_directory.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>
#include <utility>

#include "common/base/hash.h"
#include "common/base/text/parse_text.h"
#include "common/image/png.h"
#include "common/plan/effects/plan_text.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/schedule_file.h"
#include "common/protocol/fingerprint.h"
#include "coordinator/display/preview.h"
#include "coordinator/run/pass_record.h"
#include "coordinator/run/result_image.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr double kStatusSeconds = 1.0;
/// Least interval of previews, as a multiple of one preview's cost in seconds of all processors.
constexpr double kPreviewInterval = 200.0;
/// Expected core-seconds per pixel of the first preview.
constexpr double kPreviewSecondsPerPixel = 4e-8;
/// Write rate of tables and images, so that short passes share a write.
constexpr Pace kPassPace{0.0, 3.0};
/// Seconds for which the end of a run retries failed writes of results, and of summary and status.
constexpr double kResultPatience = 4.0, kSummaryPatience = 1.0;

double processors() {
    return std::max(1u, std::thread::hardware_concurrency());
}

void check_output_file(const std::string& file) {
    if (file.empty()) return;
    const fs::path path(file), folder = path.has_parent_path() ? path.parent_path() : ".";
    if (path.extension() != ".exr" && path.extension() != ".png")
        throw InputError(Location{file, 0, 0}, "the image is written as EXR, or as a PNG to look at",
                         "give it a name that ends in .exr or .png");
    if (!fs::is_directory(folder))
        throw InputError(Location{file, 0, 0}, "there is no folder " + folder.string(), "make it first");
    if (fs::is_directory(path)) throw InputError(Location{file, 0, 0}, "is a folder", "name a file");
    if (access(folder.c_str(), W_OK) != 0)  // now, not after hours of rendering
        throw InputError(Location{file, 0, 0}, "nothing can be written in " + folder.string(),
                         "choose another place or change its permissions");
}

/// Job of a run directory, with its output file checked before a folder is made.
const Job& checked(const Job& job) {
    check_output_file(job.output.file);
    return job;
}

/// Experiment of resolved.toml, which names the file of the passes if the job alone does not determine them.
Experiment experiment_of(const Job& job, const RunFacts& facts, bool resumed) {
    const bool listed = !facts.schedule.empty() || job.budget.seconds > 0 || job.budget.error > 0 || resumed;
    return {kProgramVersion, hash_text(facts.scene_hash), listed ? kScheduleFile : ""};
}

/// Whether an image gets a preview: viewers and the PNG format limit its size.
bool has_preview(std::size_t pixels) {
    constexpr std::size_t kMostPixels = std::size_t{1} << 28;
    return pixels <= kMostPixels;
}

std::vector<std::uint8_t> encode_image(const fs::path& path, const CombinedImage& image,
                                       std::span<const AovChannel> aovs, int width, int height, const CropWindow& crop,
                                       const Attributes& attributes, const Job::Output& output) {
    StoredChannels channels = result_channels(image, aovs, width, height, output.half);
    channels.image.crop = crop;
    return encode_exr(path, channels.image, attributes,
                      {std::move(channels.types), *find_compression(output.compression), output.tiles});
}

}  // namespace

RunDirectory::RunDirectory(const Job& job, RunFacts facts, const EffectPlan& plan, const RunDirectoryOptions& options)
    : job_(checked(job)),
      job_toml_(job_without_output(job)),
      storage_(plan.job.output),
      facts_(std::move(facts)),
      resolved_toml_(write_resolved(plan.job, experiment_of(job, facts_, options.resumed != nullptr))),
      folder_(job, options.use, options.interrupted),
      plan_text_(plan_text(plan, job.scene.file)),
      plan_json_(plan_json(plan, job.scene.file)),
      passes_csv_(pass_csv_header() + "\n"),
      checkpoints_(
          path(), [this] { folder_.renew(); }, job, origin_of_checkpoints(), options.resumed) {
    if (options.resumed) {
        if (newest_generation(path()) != options.resumed->newest)
            throw InputError(Location{path().string(), 0, 0}, "another process has resumed it meanwhile",
                             "start again");
        for (const PassReport& report : options.resumed->state.reports)
            note_pass(report);
    }
    write_first([&] {
        write_text(kStatusFile, status_json(facts_, RunState::running, 0, 0.0), Outlives::process);
        if (!options.resumed) write_request_files();
    });
}

void RunDirectory::write_request() {
    write_first([&] { write_request_files(); });
}

void RunDirectory::write_request_files() const {
    write_text(kJobFile, job_toml_, Outlives::power);
    write_text(kResolvedFile, resolved_toml_, Outlives::power);
    write_text(kPlanTextFile, plan_text_, Outlives::power);
    write_text(kPlanFile, plan_json_, Outlives::power);
    write_text(kPassesFile, passes_csv_, Outlives::power);
}

/// Runs the first write; throws InputError if the folder is not writable, RunError if it may be later.
void RunDirectory::write_first(const std::function<void()>& write) const {
    try {
        write();
    } catch (const std::exception& error) {
        const InputError refused(Location{path().string(), 0, 0},
                                 std::string("cannot be the run directory: ") + error.what(),
                                 "name another with --run-dir");
        const auto* const file_error = dynamic_cast<const FileError*>(&error);
        if (file_error && is_disk_trouble(file_error->code())) throw RunError(refused.what());
        throw refused;
    }
}

CheckpointOrigin RunDirectory::origin_of_checkpoints() const {
    CheckpointOrigin origin;
    origin.fingerprint = facts_.fingerprint.hash();
    origin.build = facts_.fingerprint.text();
    origin.scene_hash = facts_.scene_hash;
    origin.resolved = resolved_toml_;
    if (!job_.output.file.empty()) origin.output_file = fs::absolute(job_.output.file).string();
    origin.schedule = facts_.schedule;
    return origin;
}

void RunDirectory::write_bytes(const std::string& name, std::span<const std::uint8_t> bytes, Outlives outlives) const {
    folder_.renew();
    write_file_atomically(path() / name, bytes, outlives);
}

void RunDirectory::write_text(const std::string& name, const std::string& text, Outlives outlives) const {
    write_bytes(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, outlives);
}

void RunDirectory::put_text(const std::string& name, std::string text, Pace pace) {
    writer_.put(
        name, [this, name, text = std::move(text)] { write_text(name, text, Outlives::process); }, pace);
}

void RunDirectory::write_status(const RenderProgress& progress, double elapsed_seconds, const Farm* farm) {
    if (elapsed_seconds - last_status_ < kStatusSeconds) return;
    last_status_ = elapsed_seconds;
    put_text(kStatusFile, status_json(facts_, progress, elapsed_seconds, farm, last_pass_ ? &*last_pass_ : nullptr),
             {});
}

void RunDirectory::write_preview(std::span<const PixelEstimate> film, int width, int height, double elapsed_seconds) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (film.size() != count || !has_preview(count)) return;
    if (next_preview_ == 0)
        next_preview_ =
            std::max(1.0, kPreviewInterval * kPreviewSecondsPerPixel * static_cast<double>(count) / processors());
    if (elapsed_seconds < next_preview_) return;
    const Timer timer;
    auto pass = std::make_shared<const PassPixels>(pass_pixels(film));
    writer_.put(kPreviewFile, [this, image = newest_, spp = newest_spp_, pass, width, height] {
        const double before = thread_cpu_seconds();
        write_bytes(kPreviewFile, encode_png(preview_image(*image, spp, *pass, width, height)), Outlives::process);
        preview_seconds_ = thread_cpu_seconds() - before;
    });
    const double cost =
        timer.seconds() +
        std::max(preview_seconds_.load(), kPreviewSecondsPerPixel * static_cast<double>(count)) / processors();
    next_preview_ = elapsed_seconds + std::max(1.0, kPreviewInterval * cost);
}

void RunDirectory::note_pass(const PassReport& report) {
    passes_csv_ += pass_csv_line(report) + "\n";
    passes_.push_back(report.plan);
}

void RunDirectory::add_pass(const PassReport& report) {
    note_pass(report);
    last_pass_ = report;
    put_text(kPassesFile, passes_csv_, kPassPace);
    put_text(kScheduleFile, write_schedule(passes_), kPassPace);
}

/// Header attributes of image.exr.
Attributes RunDirectory::image_attributes(const RenderResult& result) const {
    const PassReport& last = result.passes.back();
    Attributes attributes = {
        {"treefarm.version", kProgramVersion},
        {"treefarm.build", facts_.fingerprint.text()},
        {"treefarm.spp", std::to_string(result.spp)},
        {"treefarm.job", job_toml_},
        {"treefarm.scene_hash", hash_text(facts_.scene_hash)},
        {"treefarm.image_hash", hash_text(result.image_hash)},
        {"treefarm.tree_hash", hash_text(result.tree_hash)},
        {"treefarm.passes", passes_csv_},
        {"treefarm.schedule", write_schedule(passes_)},
    };
    if (!result.aovs->empty()) attributes["treefarm.aov_hash"] = hash_text(result.aov_hash);
    if (last.error.known) {
        attributes["treefarm.error"] = number_text(last.error.relative());
        attributes["treefarm.estimated_rmse"] = number_text(last.error.rmse);
    }
    if (last.error.has_interval) {
        attributes["treefarm.error_low"] = number_text(last.error.relative_low());
        attributes["treefarm.error_high"] = number_text(last.error.relative_high());
    }
    return attributes;
}

void RunDirectory::write_image(const RenderResult& result) {
    newest_ = result.image;
    newest_spp_ = result.spp;
    writer_.put(
        kImageFile,
        [this, image = result.image, aovs = result.aovs, width = result.width, height = result.height,
         attributes = image_attributes(result)] {
            write_bytes(
                kImageFile,
                encode_image(path() / kImageFile, *image, *aovs, width, height, facts_.crop, attributes, storage_),
                Outlives::power);
            const std::lock_guard lock(on_disk_mutex_);
            on_disk_ = image;
        },
        kPassPace);
}

bool RunDirectory::image_is_on_disk(const RenderResult& result) const {
    const std::lock_guard lock(on_disk_mutex_);
    std::error_code none;
    return on_disk_.lock() == result.image && fs::exists(path() / kImageFile, none);
}

/// Final versions of the result files, most important first.
std::vector<LastFile> RunDirectory::last_files(const RenderResult& result, Outlives outlives, RunEnd& end) {
    std::vector<LastFile> files;
    const auto add = [&](const std::string& name, std::function<void()> write) {
        files.push_back({(path() / name).string(), std::move(write)});
    };
    if (!result.passes.empty()) {
        const auto encoded = std::make_shared<std::vector<std::uint8_t>>();  // shared by both files
        const auto image = [this, encoded, &result]() -> const std::vector<std::uint8_t>& {
            if (encoded->empty())
                *encoded = encode_image(path() / kImageFile, *result.image, *result.aovs, result.width, result.height,
                                        facts_.crop, image_attributes(result), storage_);
            return *encoded;
        };
        const auto picture = [&result] {
            return encode_png(result_colours(*result.image, result.width, result.height));
        };
        if (!image_is_on_disk(result))
            add(kImageFile, [=, this, &result] {
                write_bytes(kImageFile, image(), outlives);
                const std::lock_guard lock(on_disk_mutex_);
                on_disk_ = result.image;
            });
        if (!job_.output.file.empty())
            files.push_back({job_.output.file, [=, this] {
                                 if (fs::path(job_.output.file).extension() == ".png")
                                     write_output_file(
                                         job_.output.file,
                                         encode_picture(*result.image, *result.aovs, result.width, result.height),
                                         outlives);
                                 else
                                     write_output_file(job_.output.file, image(), outlives);
                             }});
        add(kPassesFile, [=, this] { write_text(kPassesFile, passes_csv_, outlives); });
        add(kScheduleFile, [=, this] { write_text(kScheduleFile, write_schedule(passes_), outlives); });
        if (result.tree.trained())
            add(kTreeFile, [=, this, &result, &end] {
                const Bytes tree = result.tree.encode();
                write_bytes(kTreeFile, tree, outlives);
                end.tree_file_hash = hash_text(hash_bytes(tree));
            });
        if (has_preview(result.image->mean.size()))
            add(kPreviewFile, [=, this] { write_bytes(kPreviewFile, picture(), outlives); });
    }
    // Only if the folder vanished: they were written at the start.
    for (const auto& [name, text] : {std::pair(kJobFile, &job_toml_), std::pair(kResolvedFile, &resolved_toml_),
                                     std::pair(kPlanTextFile, &plan_text_), std::pair(kPlanFile, &plan_json_)})
        if (std::error_code none; !fs::exists(path() / name, none))
            add(name, [=, this, name = std::string(name), text = text] { write_text(name, *text, outlives); });
    return files;
}

/// Final versions of summary.json and status.json.
std::vector<LastFile> RunDirectory::end_files(const RenderResult& result, const Farm* farm, const RunEnd& end,
                                              Outlives outlives) const {
    return {{(path() / kSummaryFile).string(),
             [=, this, &result, &end] {
                 write_text(kSummaryFile, summary_json(job_, facts_, result, farm, end), outlives);
             }},
            {(path() / kStatusFile).string(), [=, this, &result, &end] {
                 write_text(kStatusFile, status_json(facts_, end.state, result.spp, end.elapsed_seconds), outlives);
             }}};
}

void RunDirectory::write_interruption(const RenderResult& result, const Farm* farm, double elapsed_seconds) {
    if (!result.passes.empty() && !image_is_on_disk(result)) return;
    writer_.forget(kStatusFile);  // a waiting "running" must not be written later
    const RunEnd end{RunState::interrupted, "", elapsed_seconds, ""};
    std::vector<LastFile> files = end_files(result, farm, end, Outlives::process);
    write_last_files(files, 0.0);
}

std::vector<std::string> RunDirectory::take_news() {
    std::vector<std::string> news = writer_.take_news();
    for (const std::string& other : checkpoints_.take_news())
        news.push_back(other);
    return news;
}

void RunDirectory::leave(RunState state, std::uint32_t spp, double elapsed_seconds) {
    writer_.stop();
    std::vector<LastFile> files = {
        {(path() / kStatusFile).string(),
         [&] { write_text(kStatusFile, status_json(facts_, state, spp, elapsed_seconds), Outlives::power); }}};
    write_last_files(files, 0.0);
}

void RunDirectory::give_back() {
    writer_.stop();
    folder_.give_back();
}

std::vector<std::string> RunDirectory::finish(const RenderResult& result, const Farm* farm, RunEnd& end) {
    writer_.stop();
    checkpoints_.stop();
    // A run that may be killed soon does not wait for the disk, nor for files that take longer.
    const bool hurry = end.state == RunState::interrupted;
    const Outlives outlives = hurry ? Outlives::process : Outlives::power;
    std::vector<LastFile> files = last_files(result, outlives, end);
    if (hurry && (image_is_on_disk(result) || (!files.empty() && try_to_write(files.front()))))
        write_interruption(result, farm, end.elapsed_seconds);
    std::vector<std::string> failures = write_last_files(files, kResultPatience);
    for (const std::string& failure : failures)
        end.error += (end.error.empty() ? "" : "; ") + failure;
    if (!failures.empty()) end.state = RunState::failed;
    std::vector<LastFile> last = end_files(result, farm, end, outlives);
    for (const std::string& failure : write_last_files(last, kSummaryPatience)) {
        end.state = RunState::failed;
        failures.push_back(failure);
    }
    if (const std::string why = checkpoints_.finish(end.state == RunState::done); !why.empty()) failures.push_back(why);
    if (hurry) {
        for (const RunFile& file : kRunFiles)
            make_durable(path() / file.name);
        if (!job_.output.file.empty()) make_durable(job_.output.file);
    }
    if (end.state == RunState::done) folder_.remove_previous();
    return failures;
}

}  // namespace treefarm
