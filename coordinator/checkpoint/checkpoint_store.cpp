// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/checkpoint_store.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/read_bytes.h"
#include "common/base/hash.h"
#include "common/base/text/parse_text.h"
#include "common/config/aov_list.h"
#include "common/plan/resolve/resolved_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kGenerationNames = {"a.tfc", "b.tfc"};

std::string film_name(std::span<const std::uint8_t> bytes) {
    return "film-" + hash_text(hash128_bytes(bytes)) + ".tff";
}

bool is_ours(const std::string& name) {
    const auto is = [&](const char* file) { return name == file || is_temporary_of(name, file); };
    return is_film_name(name) || std::any_of(kGenerationNames.begin(), kGenerationNames.end(), is);
}

/// Content of a whole file of any size. Throws FormatError if it cannot be read.
Bytes read_file(const fs::path& path) {
    try {
        return read_bytes(path, "", std::numeric_limits<std::uintmax_t>::max());
    } catch (const InputError& error) {
        throw FormatError(error.what());
    }
}

/// A generation's file, or the reason why it is unusable.
struct Candidate {
    fs::path path;
    std::size_t slot = 0;
    SectionFile file;
    std::string fault;
};

Candidate read_candidate(const fs::path& folder, std::size_t slot) {
    Candidate candidate{folder / kGenerationNames[slot], slot, {}, ""};
    std::error_code error;
    if (!fs::exists(candidate.path, error)) {
        candidate.fault = "is missing";
        return candidate;
    }
    try {
        candidate.file = decode_sections(read_file(candidate.path));
    } catch (const FormatError& damage) {
        candidate.fault = damage.what();
    }
    return candidate;
}

std::vector<PixelEstimate> read_film(const fs::path& path, std::size_t pixels) {
    const std::string name = path.filename().string();
    std::error_code error;
    if (!fs::exists(path, error)) throw FormatError("its film " + name + " is missing");
    const Bytes bytes = read_file(path);
    if (name != film_name(bytes)) throw FormatError("its film " + name + " is damaged");
    return decode_pixels(bytes, pixels);
}

std::set<std::string> film_names(const RenderState& state) {
    std::set<std::string> names;
    for (const PassResult& film : state.films)
        names.insert(film.stored);
    return names;
}

/// Films named by the candidate that is not chosen; they are kept as long as its file.
std::set<std::string> films_of(const Candidate& candidate, const Job& job) {
    if (!candidate.fault.empty()) return {};
    try {
        return film_names(decode_state(candidate.file, decode_origin(candidate.file).pixels, aov_requests(job)));
    } catch (const FormatError&) {
        return {};
    }
}

}  // namespace

std::uint64_t newest_generation(const fs::path& run) {
    std::uint64_t newest = 0;
    for (const char* const name : kGenerationNames) {
        std::array<std::uint8_t, kSectionFileHead> head{};
        std::ifstream file(run / kCheckpointFolder / name, std::ios::binary);
        if (file.read(reinterpret_cast<char*>(head.data()), head.size()))
            newest = std::max(newest, generation_of(head));
    }
    return newest;
}

LoadedCheckpoint load_checkpoint(const fs::path& run, const std::function<void(const CheckpointOrigin&)>& check) {
    const fs::path folder = run / kCheckpointFolder;
    std::array<Candidate, 2> candidates;
    for (std::size_t slot = 0; slot < 2; ++slot)
        candidates[slot] = read_candidate(folder, slot);
    if (candidates[1].file.generation > candidates[0].file.generation) std::swap(candidates[0], candidates[1]);
    LoadedCheckpoint loaded;
    loaded.newest = newest_generation(run);
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
            loaded.slot = candidate.slot;
            const Candidate& other = &candidate == &candidates[0] ? candidates[1] : candidates[0];
            loaded.other_films = films_of(other, job);
            if (!other.fault.empty() && other.fault != "is missing")
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
                     "start again with: treefarm render " + shell_quoted((run / kJobFile).string()));
}

CheckpointStore::CheckpointStore(const fs::path& run, const LoadedCheckpoint* loaded)
    : folder_(run / kCheckpointFolder) {
    if (!loaded) return;
    generation_ = std::max(loaded->generation, loaded->newest);
    slot_ = 1 - loaded->slot;
    named_[loaded->slot] = film_names(loaded->state);
    named_[slot_] = loaded->other_films;
}

std::function<void()> CheckpointStore::prepare(const CheckpointOrigin& origin, RenderState& state) {
    Films films;
    {
        const std::lock_guard lock(mutex_);
        for (PassResult& film : state.films) {
            std::error_code none;
            if (const auto waiting = unwritten_.find(film.stored); waiting != unwritten_.end()) {
                films.insert(*waiting);
            } else if (film.stored.empty() || !fs::exists(folder_ / film.stored, none)) {
                auto bytes = std::make_shared<const Bytes>(encode_pixels(film.pixels));
                film.stored = film_name(*bytes);
                films[film.stored] = std::move(bytes);
            }
        }
        unwritten_ = films;
    }
    auto file = std::make_shared<const SectionFile>(SectionFile{++generation_, take_state(origin, state)});
    return [this, file, names = film_names(state), films = std::move(films)] { write_generation(*file, names, films); };
}

void CheckpointStore::write(const CheckpointOrigin& origin, RenderState& state) {
    make_folder();
    for (PassResult& film : state.films) {
        if (!film.stored.empty() && fs::exists(folder_ / film.stored)) continue;
        const Bytes bytes = encode_pixels(film.pixels);
        film.stored = film_name(bytes);
        write_file_atomically(folder_ / film.stored, bytes, Outlives::power);
    }
    write_generation({++generation_, encode_state(origin, state)}, film_names(state), {});
}

void CheckpointStore::write_generation(const SectionFile& file, const Names& names, const Films& films) {
    make_folder();
    write_films(films);
    std::size_t slot = 0;
    {
        const std::lock_guard lock(mutex_);
        slot = slot_;
    }
    write_pieces_atomically(folder_ / kGenerationNames[slot], SectionPieces(file).pieces(), Outlives::power);
    const std::lock_guard lock(mutex_);
    named_[slot] = names;
    slot_ = 1 - slot;
    remove_unnamed();
}

void CheckpointStore::write_films(const Films& films) {
    for (const auto& [name, bytes] : films) {
        if (!fs::exists(folder_ / name)) write_file_atomically(folder_ / name, *bytes, Outlives::power);
        const std::lock_guard lock(mutex_);
        unwritten_.erase(name);
    }
}

void CheckpointStore::make_folder() const {
    if (fs::create_directories(folder_)) make_durable(folder_);
}

/// Removes films that neither generation names, and partial files of a killed program.
void CheckpointStore::remove_unnamed() const {
    std::error_code ignored;  // a file that stays only takes space
    for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool temporary = name.find(".tmp-") != std::string::npos;
        const bool is_named = named_[0].contains(name) || named_[1].contains(name);
        if (is_ours(name) && (temporary || (is_film_name(name) && !is_named))) fs::remove(entry.path(), ignored);
    }
}

void CheckpointStore::remove() {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_, ignored))
        if (is_ours(entry.path().filename().string())) fs::remove(entry.path(), ignored);
    fs::remove(folder_, ignored);
}

}  // namespace treefarm
