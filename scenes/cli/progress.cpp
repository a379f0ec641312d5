#include "scenes/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace palpate::cli {
namespace {

constexpr auto kDrawInterval = std::chrono::milliseconds(100);

}  // namespace

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
    : label_(std::move(label)), start_(Clock::now()), last_drawn_(start_), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::update(double fraction) {
  const Clock::time_point now = Clock::now();
  if (terminal_ && now - last_drawn_ >= kDrawInterval) {
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "\r\033[K%s", progress_text(label_, fraction, elapsed_s).c_str());
    std::fflush(stderr);
    last_drawn_ = now;
    drawn_ = true;
  }
  return stop_requested() == 0;
}

}  // namespace palpate::cli
