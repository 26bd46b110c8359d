// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/base/error.h"

namespace treefarm {

namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    list.reserve(texts.size() + 1);
    for (std::string& text : texts)
        list.push_back(text.data());
    list.push_back(nullptr);
    return list;
}

std::vector<std::string> environment_with(const std::vector<std::string>& added) {
    std::vector<std::string> variables = added;
    for (char** at = environ; *at; ++at) {
        const std::string variable = *at, name = variable.substr(0, variable.find('=') + 1);
        if (std::none_of(added.begin(), added.end(), [&](const std::string& a) { return a.starts_with(name); }))
            variables.push_back(variable);
    }
    return variables;
}

/// Runs in the child between fork and exec: async-signal-safe calls only.
[[noreturn]] void become(pid_t parent, int words, bool all, const char* input, char* const* arguments,
                         char* const* variables) {
    setsid();
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);  // the parent died before prctl
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGTSTP, SIGCONT, SIGCHLD, SIGPIPE})
        ::signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    const int file = open(input, O_RDONLY);
    if (file < 0) _exit(127);
    dup2(file, STDIN_FILENO);
    dup2(words, STDERR_FILENO);
    if (all) dup2(words, STDOUT_FILENO);
    execvpe(arguments[0], arguments, variables);
    const char* const why = std::strerror(errno);
    for (const char* text : {"treefarm: cannot start ", static_cast<const char*>(arguments[0]), ": ", why, "\n"})
        if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
    _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::vector<std::string>& variables,
                           Heard heard, const std::string& input) {
    std::vector<std::string> arguments = words, environment = environment_with(variables);
    const std::vector<char*> argument_list = pointers(arguments), variable_list = pointers(environment);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw RunError(std::string("cannot make a pipe: ") + std::strerror(errno));
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0)
        become(parent, ends[1], heard == Heard::all, input.empty() ? "/dev/null" : input.c_str(), argument_list.data(),
               variable_list.data());
    const int error = errno;
    close(ends[1]);
    words_ = ends[0];
    fcntl(words_, F_SETFL, O_NONBLOCK);
    if (pid_ > 0) return;
    close(words_);
    throw RunError("cannot start " + words.front() + ": " + std::strerror(error));
}

ChildProcess::~ChildProcess() {
    if (running()) {
        signal_group(SIGKILL);
        waitpid(pid_, &status_, 0);
    }
    close(words_);
}

bool ChildProcess::running() {
    if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    return !ended_;
}

void ChildProcess::signal(int number) {
    if (running()) ::kill(pid_, number);
}

void ChildProcess::signal_group(int number) {
    if (running() && ::kill(-pid_, number) != 0) ::kill(pid_, number);
}

bool ChildProcess::succeeded() const {
    return ended_ && WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
}

std::string ChildProcess::ending() const {
    if (!ended_) return "still there";
    return WIFSIGNALED(status_) ? "signal " + std::to_string(WTERMSIG(status_))
                                : "exit code " + std::to_string(WEXITSTATUS(status_));
}

std::string ChildProcess::take_words() {
    std::string text;
    char part[4096];
    for (ssize_t count; (count = ::read(words_, part, sizeof part)) > 0;)
        text.append(part, static_cast<std::size_t>(count));
    return text;
}

}  // namespace treefarm
