// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/checkpoint_store.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/read_bytes.h"
#include "common/base/regular_file.h"
#include "common/base/text/parse_text.h"
#include "common/config/aov_list.h"
#include "common/plan/resolve/resolved_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kGenerationNames = {"a.tfc", "b.tfc"};

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

/// Damage of a film's file: its passes can be traced again.
class FilmDamage : public FormatError {
  public:
    using FormatError::FormatError;
};

/// A generation's file, or the reason why it is unusable.
struct Candidate {
    fs::path path;
    std::size_t slot = 0;
    SectionFile file;
    std::string fault;
    bool lacks_films = false;  ///< the fault is that of its films alone
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
    if (!fs::exists(path, error)) throw FilmDamage("its film " + name + " is missing");
    Bytes bytes;
    try {
        bytes = read_file(path);
    } catch (const FormatError&) {  // no regular file, or unreadable: as below
    }
    if (name != film_name(bytes)) throw FilmDamage("its film " + name + " is damaged");
    return decode_pixels(bytes, pixels);
}

std::set<std::string> film_names(const RenderState& state) {
    std::set<std::string> names;
    for (const PassResult& film : state.films)
        names.insert(film.stored);
    return names;
}

/// State of the candidate that is not chosen, without pixels; empty if its file is unusable.
RenderState state_of(const Candidate& candidate, const Job& job) {
    if (!candidate.fault.empty() && !candidate.lacks_films) return {};
    try {
        return decode_state(candidate.file, decode_origin(candidate.file).pixels, aov_requests(job));
    } catch (const FormatError&) {
        return {};
    }
}

/// Removes a folder, a pipe or a device in the place of a checkpoint's file, which could not be replaced.
void make_room_at(const fs::path& path) {
    std::error_code none;
    const fs::file_status there = fs::symlink_status(path, none);
    if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_symlink(there)) fs::remove_all(path, none);
}

std::array<Candidate, 2> candidates_of(const fs::path& run) {
    std::array<Candidate, 2> candidates;
    for (std::size_t slot = 0; slot < 2; ++slot)
        candidates[slot] = read_candidate(run / kCheckpointFolder, slot);
    if (candidates[1].file.generation > candidates[0].file.generation) std::swap(candidates[0], candidates[1]);
    return candidates;
}

/// Reads the films of a state. With `allow_lost` those without a usable file keep no pixels; else throws FilmDamage.
void read_films(const fs::path& folder, LoadedCheckpoint& loaded, bool allow_lost) {
    for (PassResult& film : loaded.state.films)
        try {
            film.pixels = read_film(folder / film.stored, loaded.origin.pixels);
        } catch (const FilmDamage& damage) {
            if (!allow_lost) throw;
            loaded.lost_films.insert(film.stored);
            loaded.warnings.push_back(folder.string() + ": " + damage.what() + "; its passes are traced again");
        }
}

/// Checkpoint of a candidate. Throws FormatError.
LoadedCheckpoint load_candidate(const Candidate& candidate, const Candidate& other,
                                const std::function<void(const CheckpointOrigin&)>& check, bool allow_lost) {
    LoadedCheckpoint loaded;
    loaded.origin = decode_origin(candidate.file);
    check(loaded.origin);
    const Job job = read_resolved(loaded.origin.resolved, candidate.path.string());
    loaded.state = decode_state(candidate.file, loaded.origin.pixels, aov_requests(job));
    read_films(candidate.path.parent_path(), loaded, allow_lost);
    loaded.generation = candidate.file.generation;
    loaded.slot = candidate.slot;
    const RenderState second = state_of(other, job);
    loaded.other_films = film_names(second);
    loaded.plans =
        other.file.generation > loaded.generation && other.lacks_films ? second.plans() : loaded.state.plans();
    if (!other.fault.empty() && other.fault != "is missing" && !(allow_lost && other.lacks_films))
        loaded.warnings.push_back(other.path.string() + " " + other.fault + "; going on from " +
                                  candidate.path.filename().string() + ": " + std::to_string(loaded.state.spp()) +
                                  " spp");
    return loaded;
}

}  // namespace

std::uint64_t newest_generation(const fs::path& run) {
    std::uint64_t newest = 0;
    for (const char* const name : kGenerationNames) {
        std::array<std::uint8_t, kSectionFileHead> head{};
        const Descriptor file = open_regular(run / kCheckpointFolder / name, O_RDONLY);
        if (file && ::read(file.fd(), head.data(), head.size()) == static_cast<ssize_t>(head.size()))
            newest = std::max(newest, generation_of(head));
    }
    return newest;
}

bool has_checkpoint_file(const fs::path& run) {
    std::error_code none;
    return std::any_of(kGenerationNames.begin(), kGenerationNames.end(), [&](const char* name) {
        return fs::exists(fs::symlink_status(run / kCheckpointFolder / name, none));
    });
}

bool can_go_on(const fs::path& run) {
    if (std::error_code none; !fs::exists(run / kJobFile, none)) return false;
    const auto candidates = candidates_of(run);
    return std::any_of(candidates.begin(), candidates.end(),
                       [](const Candidate& candidate) { return candidate.fault.empty(); });
}

LoadedCheckpoint load_checkpoint(const fs::path& run, const std::function<void(const CheckpointOrigin&)>& check) {
    const fs::path folder = run / kCheckpointFolder;
    std::array<Candidate, 2> candidates = candidates_of(run);
    for (const bool allow_lost : {false, true})
        for (Candidate& candidate : candidates) {
            if (!candidate.fault.empty() && !(allow_lost && candidate.lacks_films)) continue;
            try {
                const Candidate& other = &candidate == &candidates[0] ? candidates[1] : candidates[0];
                LoadedCheckpoint loaded = load_candidate(candidate, other, check, allow_lost);
                loaded.newest = newest_generation(run);
                return loaded;
            } catch (const FilmDamage& damage) {
                candidate.fault = damage.what();
                candidate.lacks_films = true;
            } catch (const FormatError& damage) {
                candidate.fault = damage.what();
                candidate.lacks_films = false;
            }
        }
    std::string faults;
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.path < b.path; });
    for (const Candidate& candidate : candidates)
        faults += (faults.empty() ? "" : "; ") + candidate.path.filename().string() + " " + candidate.fault;
    throw NoCheckpoint(Location{folder.string(), 0, 0}, "no usable checkpoint (" + faults + ")",
                       "start again with: treefarm render " + shell_quoted((run / kJobFile).string()));
}

CheckpointStore::CheckpointStore(const fs::path& run, const LoadedCheckpoint* loaded)
    : folder_(run / kCheckpointFolder) {
    if (!loaded) return;
    generation_ = std::max(loaded->generation, loaded->newest);
    slot_ = 1 - loaded->slot;
    named_[loaded->slot] = film_names(loaded->state);
    for (const std::string& name : named_[loaded->slot])
        if (!loaded->lost_films.contains(name)) intact_.insert(name);
    named_[slot_] = loaded->other_films;
}

std::function<void()> CheckpointStore::prepare(const CheckpointOrigin& origin, RenderState& state) {
    Films films;
    {
        const std::lock_guard lock(mutex_);
        for (PassResult& film : state.films) {
            if (const auto waiting = unwritten_.find(film.stored); waiting != unwritten_.end()) {
                films.insert(*waiting);
            } else if (!has_intact(film.stored)) {
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
        {
            const std::lock_guard lock(mutex_);
            if (has_intact(film.stored)) continue;
        }
        const Bytes bytes = encode_pixels(film.pixels);
        film.stored = film_name(bytes);
        write_film(film.stored, bytes);
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
    make_room_at(folder_ / kGenerationNames[slot]);
    write_pieces_atomically(folder_ / kGenerationNames[slot], SectionPieces(file).pieces(), Outlives::power);
    const std::lock_guard lock(mutex_);
    named_[slot] = names;
    slot_ = 1 - slot;
    remove_unnamed();
}

void CheckpointStore::write_films(const Films& films) {
    for (const auto& [name, bytes] : films) {
        write_film(name, *bytes);
        const std::lock_guard lock(mutex_);
        unwritten_.erase(name);
    }
}

void CheckpointStore::write_film(const std::string& name, std::span<const std::uint8_t> bytes) {
    const fs::path path = folder_ / name;
    {
        const std::lock_guard lock(mutex_);
        if (has_intact(name)) return;
    }
    make_room_at(path);
    write_file_atomically(path, bytes, Outlives::power);
    const std::lock_guard lock(mutex_);
    intact_.insert(name);
}

bool CheckpointStore::has_intact(const std::string& name) const {
    std::error_code none;
    return intact_.contains(name) && fs::exists(folder_ / name, none);
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
