// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/colors.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {

SpectrumSamples read_spectrum_file(const std::filesystem::path& path, const Location& asked_from) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(asked_from, "there is no file " + path_in_quotes(path.string()), "check the path");
    constexpr std::uintmax_t kMostBytes = 10'000'000;
    if (std::filesystem::file_size(path, error) > kMostBytes || error)
        throw InputError(asked_from, path_in_quotes(path.string()) + " is too large for a spectrum", "check the path");
    std::ifstream in(path);
    if (!in) throw InputError({path.string()}, "the file cannot be read", "check its permissions");
    SpectrumSamples samples;
    Location where{path.string(), 0, 1};
    std::string line;
    while (std::getline(in, line)) {
        ++where.line;
        const std::string_view text = trim(line);
        if (text.empty() || text[0] == '#') continue;
        const std::vector<double> pair = numbers_of(text, where);
        if (pair.size() != 2)
            throw InputError(where, "the line is no pair of a wavelength and a value",
                             "write for instance \"400 0.3\"");
        if (!samples.empty() && !(pair[0] > samples.back().first))
            throw InputError(where, "the wavelengths do not rise", "sort the lines");
        samples.emplace_back(pair[0], pair[1]);
    }
    if (samples.size() < 2) throw InputError({path.string()}, "a spectrum needs at least two wavelengths", "add some");
    return samples;
}

}  // namespace treefarm::mitsuba
