// SPDX-License-Identifier: Apache-2.0
#include "tests/mpi/terminal_program.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace treefarm::test {

namespace {

constexpr int kPatienceMs = 60000;

winsize size_of(int columns) {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = 30;
    return size;
}

[[noreturn]] void become(std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
    for (const std::string& variable : environment) {
        const std::size_t equals = variable.find('=');
        if (equals == std::string::npos)
            unsetenv(variable.c_str());
        else
            setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
    std::vector<char*> words;
    for (std::string& argument : arguments)
        words.push_back(argument.data());
    words.push_back(nullptr);
    execvp(words[0], words.data());
    _exit(127);
}

}  // namespace

TerminalProgram::TerminalProgram(std::vector<std::string> arguments, int columns,
                                 const std::vector<std::string>& environment) {
    const winsize size = size_of(columns);
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ == 0) become(arguments, environment);
    if (pid_ < 0) ADD_FAILURE() << "no pseudo-terminal";
}

TerminalProgram::~TerminalProgram() {
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    if (terminal_ >= 0) close(terminal_);
}

void TerminalProgram::resize(int columns) {
    const winsize size = size_of(columns);
    EXPECT_EQ(ioctl(terminal_, TIOCSWINSZ, &size), 0);
}

int TerminalProgram::follow(const std::function<void(const std::string&)>& take) {
    if (pid_ <= 0) return -1;
    char bytes[4096];
    for (;;) {
        pollfd ready{terminal_, POLLIN, 0};
        if (poll(&ready, 1, kPatienceMs) <= 0) return -1;
        const ssize_t count = read(terminal_, bytes, sizeof bytes);
        if (count <= 0) break;  // the program, and with it the other side, is gone
        take(std::string(bytes, static_cast<std::size_t>(count)));
    }
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace treefarm::test
