// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_folder.h"

#include <fstream>
#include <iterator>

namespace treefarm::test {

namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_file(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

fs::path test_folder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const fs::path folder = fs::path(::testing::TempDir()) / "treefarm_tests" / test->test_suite_name() / test->name();
    fs::create_directories(folder);
    return folder;
}

fs::path fresh_test_folder() {
    fs::remove_all(test_folder());
    return test_folder();
}

}  // namespace treefarm::test
