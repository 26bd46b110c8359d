// SPDX-License-Identifier: Apache-2.0
#include "tests/mpi/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include "common/image/exr.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {

namespace {

std::vector<std::string> environment() {
    std::vector<std::string> variables;
    for (char** at = environ; *at; ++at)
        variables.emplace_back(*at);
    for (const char* more :
         {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "OMPI_MCA_oob_tcp_if_include=lo",
          "OMPI_MCA_btl_tcp_if_include=lo", "ASAN_OPTIONS=detect_leaks=0"})  // Open MPI keeps some memory to the end
        variables.emplace_back(more);
    return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
    std::vector<char*> list;
    for (std::string& text : strings)
        list.push_back(text.data());
    list.push_back(nullptr);
    return list;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments) {
    output_ = fresh_folder("program") / "output.txt";
    std::vector<std::string> words = arguments, variables = environment();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    const int error =
        posix_spawnp(&pid_, words[0].c_str(), &actions, nullptr, pointers(words).data(), pointers(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        ADD_FAILURE() << "cannot start " << words[0];
        ended_ = true;
    }
}

Program::~Program() {
    if (!running()) return;
    ::kill(pid_, SIGKILL);  // mpirun's ranks go with it
    waitpid(pid_, &status_, 0);
}

bool Program::reap() {
    if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    return ended_;
}

bool Program::running() {
    return !reap();
}

void Program::signal(int number) {
    if (running()) ::kill(pid_, number);
}

bool Program::wait_until(const std::function<bool()>& condition, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (!running() || std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

Ending Program::wait(double seconds) {
    wait_until([] { return false; }, seconds);
    Ending ending;
    if (running()) {
        ending.timed_out = true;
        ::kill(pid_, SIGTERM);
        wait_until([] { return false; }, 3.0);
        if (running()) {
            ::kill(pid_, SIGKILL);
            waitpid(pid_, &status_, 0);
            ended_ = true;
        }
    }
    ending.code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    ending.output = read_file(output_);
    return ending;
}

pid_t Program::rank(int number) const {
    const std::string process = std::to_string(pid_);
    std::istringstream children(read_file("/proc/" + process + "/task/" + process + "/children"));
    const std::string wanted = "OMPI_COMM_WORLD_RANK=" + std::to_string(number);
    for (pid_t child = 0; children >> child;) {
        const std::string variables = '\0' + read_file("/proc/" + std::to_string(child) + "/environ");
        if (variables.find('\0' + wanted + '\0') != std::string::npos) return child;
    }
    return 0;
}

std::vector<std::string> mpirun(int ranks, const std::vector<std::string>& flags) {
    return std::vector<std::string>{
               "mpirun", "--oversubscribe",    "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1",
               "-n",     std::to_string(ranks)} +
           flags;
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::vector<std::string> small_render(const std::filesystem::path& folder, const std::string& spp,
                                      const std::vector<std::string>& options) {
    return std::vector<std::string>{TREEFARM_PROGRAM,
                                    "render",
                                    own_scene("cornell-box.xml"),
                                    "--run-dir",
                                    folder.string(),
                                    "-D",
                                    "size=64",
                                    "--spp",
                                    spp,
                                    "--threads",
                                    "1",
                                    "--set",
                                    "farm.update_seconds=0.05"} +
           options;
}

std::filesystem::path fresh_folder(const std::string& name) {
    const std::string base = ::testing::TempDir() + "/treefarm-" + std::to_string(getpid()) + "-" + name + "-";
    for (int k = 0;; ++k) {
        const std::filesystem::path path = base + std::to_string(k);
        if (std::filesystem::create_directories(path)) return path;
    }
}

nlohmann::json read_summary(const std::filesystem::path& run_directory) {
    const std::filesystem::path path = run_directory / "summary.json";
    if (!std::filesystem::exists(path)) {
        ADD_FAILURE() << "no " << path;
        return {{"state", "missing"}};
    }
    return nlohmann::json::parse(read_file(path));
}

std::ostream& operator<<(std::ostream& out, const RunHashes& hashes) {
    return out << "image " << hashes.image << " tree " << hashes.tree;
}

RunHashes hashes_of(const std::filesystem::path& run_directory) {
    const nlohmann::json summary = read_summary(run_directory);
    EXPECT_EQ(summary["state"], "done");
    return {summary["image_hash"], summary["tree_hash"]};
}

bool has_checkpoint(const std::filesystem::path& run_directory) {
    return std::filesystem::exists(run_directory / "checkpoint/a.tfc") ||
           std::filesystem::exists(run_directory / "checkpoint/b.tfc");
}

std::string spp_of(const std::filesystem::path& image) {
    return std::filesystem::exists(image) ? read_exr(image).attributes.at("treefarm.spp") : "none";
}

int passes_done(const std::filesystem::path& run_directory) {
    const std::string text = read_file(run_directory / "passes.csv");
    return static_cast<int>(std::count(text.begin(), text.end(), '\n')) - (text.empty() ? 0 : 1);
}

nlohmann::json read_json(const fs::path& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file, nullptr, false);
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at)
        ++found;
    return found;
}

}  // namespace treefarm::test
