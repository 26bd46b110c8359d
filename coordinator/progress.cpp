#include "coordinator/progress.h"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

namespace treefarm {

namespace {

constexpr double kRedrawSeconds = 0.2;
constexpr int kBarWidth = 30;

std::string duration(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02} h", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string ProgressBar::text(const RenderProgress& p, double elapsed_seconds) {
    const auto filled = static_cast<std::size_t>(p.fraction * kBarWidth);
    std::string line = "[" + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "]";
    line += fmt::format(" {:5.1f} % of {} spp, pass {} of {}", 100 * p.fraction, p.spp_total, p.pass + 1, p.pass_count);
    if (p.estimated_rmse > 0) line += fmt::format(", error {:.3g}", p.estimated_rmse);
    if (p.fraction > 0.01) line += ", " + duration(elapsed_seconds * (1 - p.fraction) / p.fraction) + " left";
    return line;
}

void ProgressBar::update(const RenderProgress& progress, double elapsed_seconds) {
    if (!shown_ || elapsed_seconds - last_ < kRedrawSeconds) return;
    last_ = elapsed_seconds;
    drawn_ = true;
    std::fprintf(stderr, "\r%s\x1b[K", text(progress, elapsed_seconds).c_str());
    std::fflush(stderr);
}

void ProgressBar::clear() {
    if (!drawn_) return;
    drawn_ = false;
    last_ = -1e9;
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
}

}  // namespace treefarm
