// SPDX-License-Identifier: Apache-2.0
#include "common/base/regular_file.h"

#include <sys/stat.h>

#include <cerrno>

namespace treefarm {

Descriptor open_regular(const std::filesystem::path& path, int flags, mode_t mode) {
    Descriptor file = Descriptor::open(path, flags | O_NONBLOCK | O_NOCTTY, mode);
    struct stat facts {};
    if (file && (::fstat(file.fd(), &facts) != 0 || !S_ISREG(facts.st_mode))) {
        file = Descriptor();
        errno = EINVAL;
    }
    return file;
}

}  // namespace treefarm
