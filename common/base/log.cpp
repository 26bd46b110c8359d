#include "common/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>

namespace treefarm {

Log make_log(const std::string& who, const std::filesystem::path& file, bool quiet) {
    std::vector<spdlog::sink_ptr> sinks;
    auto terminal = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    terminal->set_level(quiet ? spdlog::level::err : spdlog::level::info);
    terminal->set_pattern("%n: %^%l%$: %v");
    sinks.push_back(std::move(terminal));
    if (!file.empty()) {
        auto text = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string(), false);
        text->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
        sinks.push_back(std::move(text));
    }
    auto log = std::make_shared<spdlog::logger>(who, sinks.begin(), sinks.end());
    log->set_level(spdlog::level::debug);
    log->flush_on(spdlog::level::info);
    return log;
}

}  // namespace treefarm
