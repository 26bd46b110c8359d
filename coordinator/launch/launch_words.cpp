// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_words.h"

#include <vector>

#include "common/base/text/parse_text.h"

namespace treefarm {

std::string launch_words(const LaunchOptions& options) {
    const LaunchOptions usual;
    std::vector<std::string> words = {"treefarm", "launch"};
    const auto add = [&words](const char* option, const std::string& value) {
        words.emplace_back(option);
        words.push_back(value);
    };
    if (options.processes > 0) add("-n", std::to_string(options.processes));
    if (!options.hostfile.empty()) add("--hostfile", options.hostfile);
    if (!options.network.empty()) add("--network", options.network);
    if (options.mpirun != usual.mpirun) add("--mpirun", options.mpirun);
    if (options.restarts != usual.restarts) add("--restarts", std::to_string(options.restarts));
    if (options.stall_seconds != usual.stall_seconds) add("--stall-seconds", number_text(options.stall_seconds));
    if (options.no_recovery) words.emplace_back("--no-recovery");
    return shell_line(words) + " --";
}

}  // namespace treefarm
