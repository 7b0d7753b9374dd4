#include "apps/interrupt.h"

#include <csignal>
#include <ctime>

namespace kingpin::apps {
namespace {

// `timeout` and batch systems send one to the process and one to its group.
constexpr long kSameOrder = 500;  // [ms]

volatile std::sig_atomic_t interrupt = 0;
long first_time = 0;  // [ms], of the first one; set before `interrupt`

extern "C" void OnInterrupt(int signal) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const long time = 1000 * now.tv_sec + now.tv_nsec / 1000000;
  if (interrupt == 0) {
    first_time = time;
    interrupt = signal;
  } else if (time - first_time > kSameOrder) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void CatchInterrupt() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, OnInterrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool WasInterrupted() { return interrupt != 0; }

std::string FormatInterrupt() {
  switch (interrupt) {
    case SIGTERM:
      return "stopped by SIGTERM";
    case SIGHUP:
      return "stopped by SIGHUP";
    default:
      return "stopped by Ctrl-C";
  }
}

}  // namespace kingpin::apps
