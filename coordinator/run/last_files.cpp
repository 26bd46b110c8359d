// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/last_files.h"

#include <chrono>
#include <exception>
#include <new>
#include <thread>

#include "common/base/timer.h"

namespace treefarm {

namespace {

constexpr auto kPause = std::chrono::milliseconds(250);

bool try_all(std::vector<LastFile>& files) {
    bool all = true;
    for (LastFile& file : files)
        all &= try_to_write(file);
    return all;
}

}  // namespace

bool try_to_write(LastFile& file) {
    if (file.written) return true;
    try {
        file.write();
        file.written = true;
        file.failure.clear();
    } catch (const std::bad_alloc&) {
        file.failure = file.name + ": not enough memory to write it; render a smaller image";
    } catch (const std::exception& error) {
        file.failure = error.what();
    }
    return file.written;
}

std::vector<std::string> write_last_files(std::vector<LastFile>& files, double patience) {
    const Timer timer;
    while (!try_all(files) && timer.seconds() < patience)
        std::this_thread::sleep_for(kPause);
    std::vector<std::string> failures;
    for (const LastFile& file : files)
        if (!file.written) failures.push_back(file.failure);
    return failures;
}

}  // namespace treefarm
