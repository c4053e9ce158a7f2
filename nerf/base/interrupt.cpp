#include "nerf/base/interrupt.h"

#include <csignal>

namespace nerf {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not block");

void OnSignal(int signal) {
  stop_requested = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& StopOnInterrupt() {
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
  return stop_requested;
}

const std::atomic<bool>& StopRequested() { return stop_requested; }

}  // namespace nerf
