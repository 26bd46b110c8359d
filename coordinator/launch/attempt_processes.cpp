// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/attempt_processes.h"

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "common/base/text/parse_text.h"
#include "common/base/timer.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Environment of a process; another user's cannot be read.
std::string environment_of(const fs::path& process) {
    std::ifstream file(process / "environ", std::ios::binary);
    return '\0' + std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace

std::vector<pid_t> attempt_processes(const std::string& attempt) {
    std::vector<pid_t> found;
    const std::string wanted = '\0' + std::string(kAttemptVariable) + "=" + attempt + ":";
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc", error)) {
        const auto pid = parse_unsigned(entry.path().filename().string());
        if (!pid || static_cast<pid_t>(*pid) == getpid()) continue;
        if (environment_of(entry.path()).find(wanted) != std::string::npos) found.push_back(static_cast<pid_t>(*pid));
    }
    return found;
}

bool kill_attempt(const std::string& attempt, double patience) {
    const Timer timer;
    for (;;) {
        const std::vector<pid_t> processes = attempt_processes(attempt);
        if (processes.empty()) return true;
        for (const pid_t process : processes)
            ::kill(process, SIGKILL);
        if (timer.seconds() > patience) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

}  // namespace treefarm
