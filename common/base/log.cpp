#include "common/base/log.h"

#include <fcntl.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <unistd.h>

#include <mutex>

#include "common/base/printable.h"

namespace treefarm {

namespace {

/// The flag %*: the message, without what could forge lines or steer a terminal.
class PrintableMessage : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& to) override {
        const std::string text = printable({message.payload.data(), message.payload.size()});
        to.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<PrintableMessage>(); }
};

std::unique_ptr<spdlog::formatter> line_format(const char* pattern) {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<PrintableMessage>('*').set_pattern(pattern);
    return formatter;
}

/// Appends lines to a file, which is opened for each: after a disk was full, or its folder was removed and made again,
/// the log goes on. A line that cannot be written is lost; the terminal has it.
class AppendingSink : public spdlog::sinks::base_sink<std::mutex> {
  public:
    explicit AppendingSink(std::filesystem::path file) : file_(std::move(file)) {}

  protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        spdlog::memory_buf_t line;
        formatter_->format(message, line);
        const int fd = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        if (fd < 0) return;
        [[maybe_unused]] const ssize_t written = ::write(fd, line.data(), line.size());
        ::close(fd);
    }
    void flush_() override {}

  private:
    const std::filesystem::path file_;
};

}  // namespace

Log make_log(const std::string& who, const std::filesystem::path& file, bool quiet) {
    std::vector<spdlog::sink_ptr> sinks;
    auto terminal = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    terminal->set_level(quiet ? spdlog::level::err : spdlog::level::info);
    terminal->set_formatter(line_format("%n: %^%l%$: %*"));
    sinks.push_back(std::move(terminal));
    if (!file.empty()) {
        auto text = std::make_shared<AppendingSink>(file);
        text->set_formatter(line_format("%Y-%m-%d %H:%M:%S.%e %n %l: %*"));
        sinks.push_back(std::move(text));
    }
    auto log = std::make_shared<spdlog::logger>(who, sinks.begin(), sinks.end());
    log->set_level(spdlog::level::debug);
    log->flush_on(spdlog::level::info);
    return log;
}

}  // namespace treefarm
