#include "report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/base/error.h"

namespace treefarm {

namespace {

/// A folder that goes with its owner.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "treefarm-plot-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw RunError("cannot make a temporary folder for gnuplot");
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path operator/(const char* name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

/// gnuplot's exit code; 127 where there is none.
int run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& messages) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    std::string name = "gnuplot", file = script.string();
    char* arguments[] = {name.data(), file.data(), nullptr};
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, "gnuplot", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) return 127;
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

std::string draw_svg(const std::string& script, const std::string& name, int width, int height) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "plot.gp", picture = folder / "plot.svg", log = folder / "log.txt";
    std::ofstream(file) << fmt::format(
        "set encoding utf8\nset terminal svg size {},{} dynamic background 'white' name '{}' font 'sans-serif,13'\n"
        "set output '{}'\n{}\nunset output\n",
        width, height, name, picture.string(), script);
    const int code = run_gnuplot(file, log);
    if (code == 127) throw RunError("plots need gnuplot, which is not there: install gnuplot-nox");
    if (code != 0) throw RunError("gnuplot failed: " + read_text(log));
    const std::string svg = read_text(picture);
    const std::size_t begin = svg.find("<svg");
    if (begin == std::string::npos) throw RunError("gnuplot drew nothing: " + read_text(log));
    return svg.substr(begin);
}

std::string gnuplot_quoted(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

}  // namespace treefarm
