// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace treefarm::test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

inline constexpr double kSoon = 240;           ///< seconds; what is meant is "not never"
inline constexpr char kForever[] = "1000000";  ///< samples per pixel that no test waits for

/// How a program ended.
struct Ending {
    int code = -1;           ///< 128 + signal if it was killed
    bool timed_out = false;  ///< and was killed by us
    std::string output;      ///< standard output and error
};

/// A program that was started; killed if the test forgets it.
class Program {
  public:
    /// Output goes to a file in TempDir.
    explicit Program(const std::vector<std::string>& arguments);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    pid_t pid() const { return pid_; }
    /// File of what the program has printed so far.
    const std::filesystem::path& output() const { return output_; }
    bool running();
    void signal(int number);
    /// Waits for `condition` while the program runs; false if it ended, or `seconds` passed, before.
    bool wait_until(const std::function<bool()>& condition, double seconds);
    Ending wait(double seconds);
    /// The process of this rank, if the program is mpirun on this machine; 0 if there is none.
    pid_t rank(int number) const;

  private:
    bool reap();

    pid_t pid_ = 0;
    bool ended_ = false;
    int status_ = 0;
    std::filesystem::path output_;
};

/// mpirun with the flags that tests need: as root, on few cores, on the loopback only.
std::vector<std::string> mpirun(int ranks, const std::vector<std::string>& flags = {});

/// treefarm's arguments after mpirun's, or alone.
std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b);

/// A render of the Cornell box, 64 x 64, by one thread a process.
std::vector<std::string> small_render(const std::filesystem::path& folder, const std::string& spp,
                                      const std::vector<std::string>& options = {});

/// The content of a file; a discarded value where it is no JSON.
nlohmann::json read_json(const fs::path& path);

std::size_t count(const std::string& text, const std::string& what);

/// A fresh folder below TempDir.
std::filesystem::path fresh_folder(const std::string& name);

nlohmann::json read_summary(const std::filesystem::path& run_directory);

/// What the image and the tree of a render are told from others by.
struct RunHashes {
    std::string image, tree;
    bool operator==(const RunHashes&) const = default;
};
std::ostream& operator<<(std::ostream& out, const RunHashes& hashes);
/// Hashes of a render, which is expected to be done.
RunHashes hashes_of(const std::filesystem::path& run_directory);

bool has_checkpoint(const std::filesystem::path& run_directory);

/// Samples per pixel that an image says it has; "none" if there is no image.
std::string spp_of(const std::filesystem::path& image);

/// Lines of passes.csv without the header; 0 if it is not there.
int passes_done(const std::filesystem::path& run_directory);

}  // namespace treefarm::test
