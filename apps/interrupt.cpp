#include "apps/interrupt.h"

#include <csignal>

namespace kingpin::apps {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void OnInterrupt(int) {
  interrupted = 1;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

void CatchInterrupt() { std::signal(SIGINT, OnInterrupt); }

bool WasInterrupted() { return interrupted != 0; }

}  // namespace kingpin::apps
