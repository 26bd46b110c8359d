// SPDX-License-Identifier: Apache-2.0
#include "common/base/log.h"

#include <spdlog/async.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <utility>

#include "common/base/regular_file.h"
#include "common/base/text/printable.h"

namespace treefarm {

namespace {

/// Text of a message without characters that could forge log lines or control a terminal.
std::string payload(const spdlog::details::log_msg& message) {
    return printable({message.payload.data(), message.payload.size()});
}

MessageLevel message_level(spdlog::level::level_enum level) {
    return level >= spdlog::level::err    ? MessageLevel::error
           : level >= spdlog::level::warn ? MessageLevel::warning
           : level >= spdlog::level::info ? MessageLevel::info
                                          : MessageLevel::detail;
}

class TellingSink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  public:
    explicit TellingSink(TellMessage tell) : tell_(std::move(tell)) {}

  private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        tell_(message_level(message.level), payload(message));
    }
    void flush_() override {}

    const TellMessage tell_;
};

/// Format flag %*: the message on one line, with control characters replaced.
class PrintableMessage final : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& to) override {
        const std::string text = payload(message);
        to.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<PrintableMessage>(); }
};

/// File sink that opens the file for each line: the log resumes after a full disk, or after its folder was removed and
/// made again. A line that cannot be written is lost in the file; the terminal has it.
class AppendingSink final : public spdlog::sinks::base_sink<std::mutex> {
  public:
    explicit AppendingSink(std::filesystem::path file) : file_(std::move(file)) {
        auto formatter = std::make_unique<spdlog::pattern_formatter>();
        formatter->add_flag<PrintableMessage>('*').set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %*");
        set_formatter(std::move(formatter));
    }

  private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        spdlog::memory_buf_t line;
        formatter_->format(message, line);
        Descriptor file = open();
        if (!file && errno == ELOOP && ::unlink(file_.c_str()) == 0) file = open();  // a link is not followed
        if (!file) return;
        [[maybe_unused]] const ssize_t written = ::write(file.fd(), line.data(), line.size());
    }
    Descriptor open() const { return open_regular(file_, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW, 0666); }
    void flush_() override {}

    const std::filesystem::path file_;
};

/// File sink with a thread of its own: the thread that logs also answers workers and cannot wait for a stalled disk. If
/// more lines wait than the queue holds, the oldest are lost in the file; the terminal has them.
class BackgroundFileSink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  public:
    BackgroundFileSink(const std::string& who, const std::filesystem::path& file)
        : pool_(std::make_shared<spdlog::details::thread_pool>(kLines, 1)),
          logger_(std::make_shared<spdlog::async_logger>(who, std::make_shared<AppendingSink>(file), pool_,
                                                         spdlog::async_overflow_policy::overrun_oldest)) {
        logger_->set_level(spdlog::level::trace);
    }

  private:
    static constexpr std::size_t kLines = 4096;

    void sink_it_(const spdlog::details::log_msg& message) override {
        logger_->log(message.time, message.source, message.level, message.payload);
    }
    void flush_() override {}

    const std::shared_ptr<spdlog::details::thread_pool> pool_;
    const std::shared_ptr<spdlog::async_logger> logger_;
};

MessageLevel least_level(Verbosity verbosity) {
    return verbosity == Verbosity::quiet    ? MessageLevel::error
           : verbosity == Verbosity::normal ? MessageLevel::info
                                            : MessageLevel::detail;
}

}  // namespace

Log make_log(const std::string& who, const std::filesystem::path& file, const TellMessage& tell) {
    std::vector<spdlog::sink_ptr> sinks;
    if (tell) sinks.push_back(std::make_shared<TellingSink>(tell));
    if (!file.empty()) sinks.push_back(std::make_shared<BackgroundFileSink>(who, file));
    auto log = std::make_shared<spdlog::logger>(who, sinks.begin(), sinks.end());
    log->set_level(spdlog::level::debug);
    log->flush_on(spdlog::level::info);
    return log;
}

TellMessage console_messages(const std::string& who, const ConsolePtr& console, Verbosity verbosity) {
    return [who, console, least = least_level(verbosity)](MessageLevel level, const std::string& text) {
        if (level < least) return;
        if (level < MessageLevel::warning) return console->line(text);
        const bool error = level == MessageLevel::error;
        const std::string word = error ? "error" : "warning";
        const bool colour = console->kind().colour;
        console->line(who + ": " + (colour ? (error ? "\x1b[1;31m" : "\x1b[1;33m") + word + "\x1b[m" : word) + ": " +
                      text);
    };
}

Log make_log(const std::string& who, const std::filesystem::path& file, const ConsolePtr& console,
             Verbosity verbosity) {
    return make_log(who, file, console_messages(who, console, verbosity));
}

}  // namespace treefarm
