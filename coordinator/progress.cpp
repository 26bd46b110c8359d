#include "coordinator/progress.h"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

namespace treefarm {

namespace {

constexpr double kRedrawSeconds = 0.2;
constexpr int kBarWidth = 30;

}  // namespace

std::string ProgressBar::text(const RenderProgress& p, double elapsed_seconds) {
    const auto filled = static_cast<std::size_t>(p.fraction * kBarWidth);
    std::string line = "[" + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "]";
    const std::string of = p.pass_count > 0 ? fmt::format(" of {}", p.pass_count) : "";
    line += p.spp_total > 0
                ? fmt::format(" {:5.1f} % of {} spp, pass {}{}", 100 * p.fraction, p.spp_total, p.pass + 1, of)
                : fmt::format(" pass {}", p.pass + 1);
    if (p.error.known) line += fmt::format(", error {:.3g} %", 100 * p.error.relative());
    if (p.fraction > 0.01) line += ", " + duration_text(elapsed_seconds * (1 - p.fraction) / p.fraction) + " left";
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
