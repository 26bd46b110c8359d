// SPDX-License-Identifier: Apache-2.0
// Prints the table of docs/generated/hard-cases.md that compares our functions with 113-bit ones.
// usage: oracle_table [INPUTS]     per row, default 1000000; exit code 1 if a bound is not kept
#include <cstdio>
#include <cstdlib>

#include "tests/oracle/oracle.h"

int main(int argc, char** argv) {
    const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
    std::printf("| function | inputs | error | worst | bound | worst input |\n|---|---|---|---|---|---|\n");
    bool kept = true;
    for (const treefarm::oracle::Row& row : treefarm::oracle::all(count)) {
        kept = kept && row.worst <= row.bound;
        std::printf("| %s | %llu | %s | %.2g | %.2g | `%s` |\n", row.what.c_str(),
                    static_cast<unsigned long long>(row.inputs), row.measure.c_str(), row.worst, row.bound,
                    row.worst_input.c_str());
    }
    return kept ? 0 : 1;
}
