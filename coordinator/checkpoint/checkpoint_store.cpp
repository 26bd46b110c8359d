// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/checkpoint_store.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/hash.h"
#include "common/config/aov_list.h"
#include "common/image/atomic_file.h"
#include "common/image/read_bytes.h"
#include "common/plan/resolved_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kGenerationNames = {"a.tfc", "b.tfc"};

bool is_film(const std::string& name) {
    return name.starts_with("film-");
}

bool is_ours(const std::string& name) {
    const auto is = [&](const char* file) { return name == file || is_temporary_of(name, file); };
    return is_film(name) || std::any_of(kGenerationNames.begin(), kGenerationNames.end(), is);
}

/// A generation's file, or why it is not usable.
struct Candidate {
    fs::path path;
    SectionFile file;
    std::string fault;
};

Candidate read_candidate(const fs::path& path) {
    Candidate candidate{path, {}, ""};
    std::error_code error;
    if (!fs::exists(path, error)) {
        candidate.fault = "is missing";
        return candidate;
    }
    try {
        candidate.file = decode_sections(read_bytes(path, ""));
    } catch (const InputError& unreadable) {
        candidate.fault = unreadable.what();
    } catch (const FormatError& damage) {
        candidate.fault = damage.what();
    }
    return candidate;
}

std::vector<PixelEstimate> read_film(const fs::path& path, std::size_t pixels) {
    std::error_code error;
    if (!fs::exists(path, error)) throw FormatError("its film " + path.filename().string() + " is missing");
    const std::vector<std::uint8_t> bytes = read_bytes(path, "");
    if (path.filename() != "film-" + hash_text(hash128_bytes(bytes)) + ".tff")
        throw FormatError("its film " + path.filename().string() + " is damaged");
    return decode_pixels(bytes, pixels);
}

}  // namespace

LoadedCheckpoint load_checkpoint(const fs::path& run, const std::function<void(const CheckpointOrigin&)>& check) {
    const fs::path folder = run / kCheckpointFolder;
    std::array<Candidate, 2> candidates;
    for (std::size_t slot = 0; slot < 2; ++slot)
        candidates[slot] = read_candidate(folder / kGenerationNames[slot]);
    if (candidates[1].file.generation > candidates[0].file.generation) std::swap(candidates[0], candidates[1]);
    LoadedCheckpoint loaded;
    for (Candidate& candidate : candidates) {
        if (!candidate.fault.empty()) continue;
        try {
            loaded.origin = decode_origin(candidate.file);
            check(loaded.origin);
            const Job job = read_resolved(loaded.origin.resolved, candidate.path.string());
            loaded.state = decode_state(candidate.file, loaded.origin.pixels, aov_requests(job));
            for (PassResult& film : loaded.state.films)
                film.pixels = read_film(folder / film.stored, loaded.origin.pixels);
            loaded.generation = candidate.file.generation;
            for (const Candidate& other : candidates)
                if (&other != &candidate && !other.fault.empty() && other.fault != "is missing")
                    loaded.warnings.push_back(other.path.string() + " " + other.fault + "; going on from " +
                                              candidate.path.filename().string() + ": " +
                                              std::to_string(loaded.state.spp()) + " spp");
            return loaded;
        } catch (const FormatError& damage) {
            candidate.fault = damage.what();
        }
    }
    std::string faults;
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.path < b.path; });
    for (const Candidate& candidate : candidates)
        faults += (faults.empty() ? "" : "; ") + candidate.path.filename().string() + " " + candidate.fault;
    throw InputError(Location{folder.string(), 0, 0}, "no usable checkpoint (" + faults + ")",
                     "start again with: treefarm render " + (run / "job.toml").string());
}

CheckpointStore::CheckpointStore(fs::path run, const LoadedCheckpoint* loaded)
    : folder_(std::move(run) / kCheckpointFolder) {
    if (!loaded) return;
    generation_ = loaded->generation;
    for (const PassResult& film : loaded->state.films)
        named_[generation_ % 2].insert(film.stored);
}

std::function<void()> CheckpointStore::prepare(const CheckpointOrigin& origin, RenderState& state) {
    Names films;
    bytes_ = 0;
    {
        const std::lock_guard lock(mutex_);
        for (PassResult& film : state.films) {
            std::error_code none;
            const bool kept =
                !film.stored.empty() && (unwritten_.contains(film.stored) || fs::exists(folder_ / film.stored, none));
            if (!kept) {
                auto bytes = std::make_shared<const Bytes>(encode_pixels(film.pixels));
                film.stored = "film-" + hash_text(hash128_bytes(*bytes)) + ".tff";
                unwritten_[film.stored] = {std::move(bytes), generation_ + 1};
            }
            films.insert(film.stored);
            bytes_ += film.pixels.size() * kStoredPixelBytes;
        }
    }
    auto file = std::make_shared<SectionFile>();
    file->generation = ++generation_;
    file->sections = encode_state(origin, state);
    for (const Section& section : file->sections)
        bytes_ += section.bytes.size();
    return [this, file, films = std::move(films)] { write(*file, films); };
}

void CheckpointStore::write(const SectionFile& file, const Names& films) {
    fs::create_directories(folder_);
    write_films(films);
    const std::size_t slot = file.generation % 2;
    write_file_atomically(folder_ / kGenerationNames[slot], encode_sections(file), Outlives::power);
    const std::lock_guard lock(mutex_);
    named_[slot] = films;
    std::erase_if(unwritten_, [&](const auto& film) {  // superseded before they were written
        return film.second.generation <= file.generation && !films.contains(film.first);
    });
    remove_unnamed();
}

void CheckpointStore::write_films(const Names& films) {
    for (const std::string& name : films) {
        std::shared_ptr<const Bytes> bytes;
        {
            const std::lock_guard lock(mutex_);
            if (const auto found = unwritten_.find(name); found != unwritten_.end()) bytes = found->second.bytes;
        }
        if (!bytes) continue;
        write_file_atomically(folder_ / name, *bytes, Outlives::power);
        const std::lock_guard lock(mutex_);
        unwritten_.erase(name);
    }
}

/// Removes films that neither generation names, and what a killed program was writing.
void CheckpointStore::remove_unnamed() const {
    std::error_code ignored;  // what stays takes room, no more
    for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool temporary = name.find(".tmp-") != std::string::npos;
        const bool is_named = named_[0].contains(name) || named_[1].contains(name);
        if (is_ours(name) && (temporary || (is_film(name) && !is_named))) fs::remove(entry.path(), ignored);
    }
}

void CheckpointStore::remove() {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_, ignored))
        if (is_ours(entry.path().filename().string())) fs::remove(entry.path(), ignored);
    fs::remove(folder_, ignored);
}

}  // namespace treefarm
