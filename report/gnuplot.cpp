// SPDX-License-Identifier: Apache-2.0
#include "report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/read_bytes.h"
#include "report/html.h"

namespace treefarm {

namespace {

/// A temporary folder, removed with this object.
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

/// Exit code of gnuplot; 127 if it is not installed.
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

/// SVG without `<title>` elements: gnuplot's are plot names, which a browser shows as tooltips.
std::string without_titles(std::string svg) {
    constexpr std::string_view begin = "<title>", end = "</title>";
    for (std::size_t at = 0; (at = svg.find(begin, at)) != std::string::npos;) {
        const std::size_t to = svg.find(end, at);
        if (to == std::string::npos) break;
        svg.erase(at, to + end.size() - at);
    }
    return svg;
}

/// SVG with a title and a description for blind readers, in place of gnuplot's.
std::string described(const std::string& drawn, const Picture& picture) {
    std::string svg = without_titles(drawn);
    const std::size_t from = svg.find("<desc>"), to = svg.find("</desc>");
    if (from != std::string::npos && to != std::string::npos) svg.erase(from, to + 7 - from);
    const std::string id = html_text(picture.name);
    const std::size_t tag_end = svg.find('>');
    if (tag_end == std::string::npos) return svg;
    svg.insert(tag_end + 1, fmt::format("\n<title id=\"{0}-title\">{1}</title>\n<desc id=\"{0}-desc\">{2}</desc>\n", id,
                                        html_text(picture.title), html_text(picture.description)));
    svg.insert(tag_end, fmt::format(R"( role="img" aria-labelledby="{0}-title" aria-describedby="{0}-desc")", id));
    return svg;
}

/// Output of gnuplot for a picture on a terminal; no value if it fails, with its output in `messages`.
std::optional<std::string> drawn(const Picture& picture, const std::string& terminal, std::string& messages) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "plot.gp", out = folder / "plot", log = folder / "log.txt";
    std::ofstream(file) << fmt::format("set encoding utf8\nset terminal {}\nset output '{}'\n{}\nunset output\n",
                                       terminal, out.string(), picture.script);
    const int code = run_gnuplot(file, log);
    if (code == 127) throw RunError("plots need gnuplot, which is not there: install gnuplot-nox");
    messages = read_text(log);
    if (code != 0) return std::nullopt;
    return read_text(out);
}

std::string drawn_svg(const Picture& picture, int width, int height, const std::string& font, double font_size) {
    std::string messages;
    const auto svg = drawn(picture,
                           fmt::format("svg size {},{} dynamic background 'white' name '{}' font {} fontscale 1", width,
                                       height, picture.name, gnuplot_quoted(fmt::format("{},{:g}", font, font_size))),
                           messages);
    const std::size_t begin = svg ? svg->find("<svg") : std::string::npos;
    if (begin == std::string::npos) throw RunError("gnuplot failed: " + messages);
    return described(svg->substr(begin), picture);
}

void write_file(const std::filesystem::path& path, const std::string& bytes) {
    write_file_atomically(path, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

std::string draw_svg(const Picture& picture) {
    return picture.script.empty() ? "" : drawn_svg(picture, picture.width, picture.height, "sans-serif", 13);
}

bool write_figure(const Picture& picture, const FigureStyle& style, const std::filesystem::path& folder) {
    constexpr double kPixelsPerInch = 96, kPointsPerInch = 72;
    const double height = style.width_inches * picture.height / picture.width;
    const auto pixels = [&](double inches) { return static_cast<int>(std::lround(inches * kPixelsPerInch)); };
    write_file(folder / (picture.name + ".svg"),
               "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" +
                   drawn_svg(picture, pixels(style.width_inches), pixels(height), style.font,
                             style.font_points * kPixelsPerInch / kPointsPerInch));
    write_file(folder / (picture.name + ".csv"), picture.data);
    std::string messages;
    const auto pdf = drawn(picture,
                           fmt::format("pdfcairo size {:.3f}in,{:.3f}in font {}", style.width_inches, height,
                                       gnuplot_quoted(fmt::format("{},{:g}", style.font, style.font_points))),
                           messages);
    if (!pdf && messages.find("unknown or ambiguous terminal") != std::string::npos) return false;
    if (!pdf) throw RunError("gnuplot failed: " + messages);
    write_file(folder / (picture.name + ".pdf"), *pdf);
    return true;
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
