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

std::atomic<bool> interrupt_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

struct sigaction action_before;
bool handler_installed = false;

// The second SIGINT finds the handler that was there before.
extern "C" void request_interrupt(int) {
  interrupt_requested.store(true);
  sigaction(SIGINT, &action_before, nullptr);
}

void install_handler() {
  interrupt_requested.store(false);
  sigaction(SIGINT, nullptr, &action_before);
  handler_installed = action_before.sa_handler != SIG_IGN && action_before.sa_handler != request_interrupt;
  if (!handler_installed) return;
  struct sigaction action {};
  action.sa_handler = request_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // a file being read is not cut short
  sigaction(SIGINT, &action, nullptr);
}

void restore_handler() {
  if (handler_installed) sigaction(SIGINT, &action_before, nullptr);
  handler_installed = false;
}

constexpr auto kDrawInterval = std::chrono::milliseconds(100);

}  // namespace

bool interrupted() noexcept { return interrupt_requested.load(); }

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
  install_handler();
}

ProgressLine::~ProgressLine() {
  restore_handler();
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::update(double fraction) {
  if (terminal_) {
    const Clock::time_point now = Clock::now();
    if (now - last_drawn_ >= kDrawInterval) draw(fraction, now);
  }
  return !interrupted();
}

void ProgressLine::draw(double fraction, Clock::time_point now) {
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", progress_text(label_, fraction, elapsed_s).c_str());
  std::fflush(stderr);
  last_drawn_ = now;
  drawn_ = true;
}

}  // namespace palpate::cli
