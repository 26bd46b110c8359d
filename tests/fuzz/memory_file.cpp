#include "tests/fuzz/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace treefarm::fuzz {

MemoryFile::MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("input", 0)) {
    for (std::size_t at = 0; at < size;) {
        const ssize_t written = write(descriptor_, data + at, size - at);
        if (written <= 0) {
            std::perror("a file in memory");
            std::_Exit(2);
        }
        at += static_cast<std::size_t>(written);
    }
    path_ = "/proc/self/fd/" + std::to_string(descriptor_);
}

MemoryFile::~MemoryFile() {
    close(descriptor_);
}

}  // namespace treefarm::fuzz
