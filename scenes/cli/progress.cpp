#include "scenes/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "engine/base/text.h"

namespace palpate::cli {

namespace {

constexpr auto kDrawInterval = std::chrono::milliseconds(100);
bool hidden = false;

}  // namespace

void hide_progress() { hidden = true; }

std::string progress_text(const std::string& label, double fraction, double elapsed_s) {
  fraction = fraction > 0.0 ? std::min(fraction, 1.0) : 0.0;  // a NaN is 0
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "  %3.0f %%", 100.0 * fraction);
  std::string text = label + numbers;
  if (fraction >= 0.02 && elapsed_s >= 1.0)
    text += "  " + fixed(elapsed_s * (1.0 - fraction) / fraction, 0) + " s left";
  return text;
}

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)),
      start_(Clock::now()),
      last_drawn_(start_),
      terminal_(!hidden && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::update(double fraction) {
  const Clock::time_point now = Clock::now();
  most_ = std::max(most_, fraction);
  if (terminal_ && now - last_drawn_ >= kDrawInterval) {
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "\r\033[K%s", progress_text(label_, most_, elapsed_s).c_str());
    std::fflush(stderr);
    last_drawn_ = now;
    drawn_ = true;
  }
  return stop_requested() == 0;
}

}  // namespace palpate::cli
