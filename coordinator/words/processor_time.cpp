// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/processor_time.h"

#include <spdlog/fmt/fmt.h>

namespace treefarm {

std::string ProcessorTime::add(int worker, double busy_seconds, double core_seconds) {
    constexpr double kLeastSeconds = 10.0, kLeastShare = 0.5;
    busy_ += busy_seconds;
    core_ += core_seconds;
    if (told_ || busy_ < kLeastSeconds || core_ >= kLeastShare * busy_) return "";
    told_ = true;
    return fmt::format(
        "worker {} had {:.0f} % of its processors: other programs use them, or it has more threads than processors",
        worker, 100 * core_ / busy_);
}

}  // namespace treefarm
