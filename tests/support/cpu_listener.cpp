// SPDX-License-Identifier: Apache-2.0
// Linked into every test program: where TREEFARM_CPU_FILE names a file, each test appends its CPU seconds to it, those
// of the processes that it waited for included ("program suite.name seconds"). deploy/test holds them against a budget.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

double cpu_seconds() {
    double seconds = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

class CpuListener : public testing::EmptyTestEventListener {
  public:
    explicit CpuListener(std::string file) : file_(std::move(file)) {}

  private:
    void OnTestStart(const testing::TestInfo&) override { begin_ = cpu_seconds(); }
    void OnTestEnd(const testing::TestInfo& test) override {
        const std::string line = std::filesystem::read_symlink("/proc/self/exe").filename().string() + " " +
                                 test.test_suite_name() + "." + test.name() + " " +
                                 std::to_string(cpu_seconds() - begin_) + "\n";
        // One write of a line to a file opened for appending: programs that run side by side do not mix their lines.
        const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
        if (file < 0 || write(file, line.data(), line.size()) < 0) ADD_FAILURE() << "cannot write " << file_;
        if (file >= 0) close(file);
    }

    std::string file_;
    double begin_ = 0;
};

const bool kListens = [] {
    const char* file = std::getenv("TREEFARM_CPU_FILE");
    if (file != nullptr && *file != '\0') testing::UnitTest::GetInstance()->listeners().Append(new CpuListener(file));
    return file != nullptr;
}();

}  // namespace
