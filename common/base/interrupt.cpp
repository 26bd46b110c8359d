// SPDX-License-Identifier: Apache-2.0
#include "common/base/interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <initializer_list>

namespace treefarm {

bool is_ignored(int number) {
    struct sigaction action {};
    return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void ignore_broken_pipes() {
    signal(SIGPIPE, SIG_IGN);
}

void ignore_size_limits() {
    signal(SIGXFSZ, SIG_IGN);
}

InterruptWatch::InterruptWatch() : parent_(getppid()) {
    sigemptyset(&watched_);
    for (const int number : {SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU})
        sigaddset(&watched_, number);
    // A blocked signal stays pending even if it is ignored.
    if (!is_ignored(SIGHUP)) sigaddset(&watched_, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &watched_, nullptr);
}

bool InterruptWatch::has_come(const sigset_t& signals) {
    const timespec now{};
    siginfo_t come{};
    if (!seen_ && sigtimedwait(&signals, &come, &now) > 0) {
        seen_ = true;
        told_by_parent_ = come.si_signo == SIGTERM && come.si_pid == parent_;
    }
    return seen_;
}

bool InterruptWatch::interrupted() {
    return has_come(watched_);
}

bool InterruptWatch::terminated() {
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGTERM);
    sigaddset(&only, SIGXCPU);
    return has_come(only);
}

}  // namespace treefarm
