#include "cli/interrupt.h"

#include <pthread.h>
#include <signal.h>

namespace treefarm {

namespace {

sigset_t watched_signals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    return set;
}

}  // namespace

InterruptWatch::InterruptWatch() {
    const sigset_t set = watched_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

bool InterruptWatch::interrupted() {
    if (seen_) return true;
    const sigset_t set = watched_signals();
    const timespec now{};
    seen_ = sigtimedwait(&set, nullptr, &now) > 0;
    return seen_;
}

}  // namespace treefarm
