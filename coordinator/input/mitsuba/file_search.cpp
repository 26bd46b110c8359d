// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/file_search.h"

#include <algorithm>

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {
namespace {

using std::filesystem::path;

bool is_there(const path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error);
}

std::string lower(std::string text) {
    for (char& c : text)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// Entry of the folder that equals `name` up to the case of letters; of several, the first in order.
path similar_entry(const path& folder, const std::string& name) {
    std::error_code error;
    const std::string wanted = lower(name);
    std::vector<path> similar;
    std::filesystem::directory_iterator entry(folder.empty() ? path(".") : folder, error), end;
    for (; !error && entry != end; entry.increment(error))
        if (lower(entry->path().filename().string()) == wanted) similar.push_back(entry->path().filename());
    return similar.empty() ? path() : *std::min_element(similar.begin(), similar.end());
}

/// Existing file whose path equals `name` up to the case of letters, or an empty path.
path find_similar(const path& folder, const path& name) {
    path found = folder;
    for (const path& part : name) {
        if (is_there(found / part)) {
            found /= part;
            continue;
        }
        const path entry = similar_entry(found, part.string());
        if (entry.empty()) return {};
        found /= entry;
    }
    return found;
}

}  // namespace

void FileSearch::add(const std::string& name, const path& own_folder, const Location& where) {
    const path folder = find(name, own_folder);
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(where, "there is no folder " + path_in_quotes(folder.string()), "check the path");
    folders_.push_back(folder);
}

path FileSearch::find(const std::string& name, const path& own_folder) const {
    std::vector<path> folders(folders_.rbegin(), folders_.rend());
    folders.push_back(own_folder);
    for (const path& folder : folders)
        if (is_there(folder / name)) return folder / name;
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    for (const path& folder : folders)
        if (path found = find_similar(folder, portable); !found.empty()) return found;
    return own_folder / name;
}

}  // namespace treefarm::mitsuba
