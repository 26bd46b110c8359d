// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mesh_bytes.h"

#include <zlib.h>

namespace treefarm::test {

std::string serialized_file(const std::vector<std::string>& payloads, int version) {
    std::string file;
    std::vector<std::uint64_t> offsets;
    for (const std::string& payload : payloads) {
        offsets.push_back(file.size());
        append<std::uint16_t>(file, 0x041C);
        append(file, static_cast<std::uint16_t>(version));
        uLongf size = compressBound(static_cast<uLong>(payload.size()));
        std::string packed(size, '\0');
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(payload.data()),
                 static_cast<uLong>(payload.size()));
        file.append(packed, 0, size);
    }
    for (const std::uint64_t offset : offsets)
        if (version == 4)
            append(file, offset);
        else
            append(file, static_cast<std::uint32_t>(offset));
    append(file, static_cast<std::uint32_t>(payloads.size()));
    return file;
}

}  // namespace treefarm::test
