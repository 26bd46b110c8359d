// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_signals.h"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/interrupt.h"

namespace treefarm {

LaunchSignals::LaunchSignals() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int number : {SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU, SIGTSTP, SIGCONT, SIGCHLD})
        sigaddset(&watched, number);
    if (!is_ignored(SIGHUP)) sigaddset(&watched, SIGHUP);
    sigprocmask(SIG_BLOCK, &watched, &before_);
    descriptor_ = signalfd(-1, &watched, SFD_NONBLOCK | SFD_CLOEXEC);
    if (descriptor_ < 0) throw RunError(std::string("cannot wait for signals: ") + std::strerror(errno));
}

LaunchSignals::~LaunchSignals() {
    close(descriptor_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
}

std::vector<int> LaunchSignals::take() {
    std::vector<int> numbers;
    signalfd_siginfo facts{};
    while (read(descriptor_, &facts, sizeof facts) == sizeof facts)
        numbers.push_back(static_cast<int>(facts.ssi_signo));
    return numbers;
}

}  // namespace treefarm
