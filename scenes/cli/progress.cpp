#include "scenes/cli/progress.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <utility>

namespace palpate::cli {
namespace {

// The signal that asked for the end, 0 until one did.
std::atomic<int> stop_asked_by{0};
static_assert(std::atomic<int>::is_always_lock_free, "set by a signal handler");

struct Listened {
  int number;
  struct sigaction before {};
  bool installed = false;
};
Listened listened[] = {{SIGINT}, {SIGTERM}, {SIGHUP}};

// The second signal finds the handler that was there before.
extern "C" void ask_to_stop(int number) {
  stop_asked_by.store(number);
  for (const Listened& signal : listened) {
    if (signal.number == number) sigaction(number, &signal.before, nullptr);
  }
}

void install_handlers() {
  stop_asked_by.store(0);
  for (Listened& signal : listened) {
    sigaction(signal.number, nullptr, &signal.before);
    signal.installed = signal.before.sa_handler != SIG_IGN && signal.before.sa_handler != ask_to_stop;
    if (!signal.installed) continue;
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;  // a file being read is not cut short
    sigaction(signal.number, &action, nullptr);
  }
}

void restore_handlers() {
  for (Listened& signal : listened) {
    if (signal.installed) sigaction(signal.number, &signal.before, nullptr);
    signal.installed = false;
  }
}

constexpr auto kDrawInterval = std::chrono::milliseconds(100);

}  // namespace

int interrupted() noexcept { return stop_asked_by.load(); }

std::string progress_text(const std::string& label, double fraction, double elapsed_s) {
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  char numbers[64];
  if (done >= 0.02 && elapsed_s >= 1.0) {
    const double left_s = elapsed_s * (1.0 - done) / done;
    std::snprintf(numbers, sizeof numbers, "  %3.0f %%  %.0f s left", 100.0 * done, left_s);
  } else {
    std::snprintf(numbers, sizeof numbers, "  %3.0f %%", 100.0 * done);
  }
  return label + numbers;
}

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)),
      start_(Clock::now()),
      last_drawn_(start_),
      terminal_(isatty(STDERR_FILENO) == 1) {
  install_handlers();
}

ProgressLine::~ProgressLine() {
  restore_handlers();
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::update(double fraction) {
  if (terminal_) {
    const Clock::time_point now = Clock::now();
    if (now - last_drawn_ >= kDrawInterval) draw(fraction, now);
  }
  return interrupted() == 0;
}

void ProgressLine::draw(double fraction, Clock::time_point now) {
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", progress_text(label_, fraction, elapsed_s).c_str());
  std::fflush(stderr);
  last_drawn_ = now;
  drawn_ = true;
}

}  // namespace palpate::cli
