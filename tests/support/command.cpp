// SPDX-License-Identifier: Apache-2.0
#include "tests/support/command.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

namespace treefarm::test {

Ended run_command(const std::string& command) {
    Ended ended;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return ended;
    std::array<char, 4096> buffer;
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe))
        ended.output.append(buffer.data(), size);
    const int status = pclose(pipe);
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ended;
}

Ended run_treefarm(const std::string& arguments) {
    return run_command("'" TREEFARM_PROGRAM "' " + arguments);
}

}  // namespace treefarm::test
