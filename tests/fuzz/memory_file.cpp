// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace treefarm::fuzz {

MemoryFile::MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("input", 0)) {
    path_ = "/proc/self/fd/" + std::to_string(descriptor_);
    assign(data, size);
}

void MemoryFile::assign(const std::uint8_t* data, std::size_t size) {
    bool done = ftruncate(descriptor_, 0) == 0;
    for (std::size_t at = 0; done && at < size;) {
        const ssize_t written = pwrite(descriptor_, data + at, size - at, static_cast<off_t>(at));
        done = written > 0;
        at += done ? static_cast<std::size_t>(written) : 0;
    }
    if (done) return;
    std::perror("a file in memory");
    std::_Exit(2);
}

MemoryFile::~MemoryFile() {
    close(descriptor_);
}

}  // namespace treefarm::fuzz
