#include "engine/base/signals.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <functional>

namespace palpate {
namespace {

using testing::ExitedWithCode;
using testing::KilledBySignal;

// Standard error tells what has happened; f: the forces were stopped.
void trace(char letter) { [[maybe_unused]] const auto written = write(STDERR_FILENO, &letter, 1); }

// Runs `body` with forces to stop and default handlers. In a child process (EXPECT_EXIT).
void run(const std::function<void()>& body) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) signal(number, SIG_DFL);
  stop_forces_by([]() noexcept { trace('f'); });
  install_signal_handlers();
  body();
  _exit(0);
}

TEST(Signals, ForcesStopBeforeASignalEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGABRT})
    EXPECT_EXIT(run([=] { raise(number); }), KilledBySignal(number), "^f$");
}

TEST(Signals, EveryOrderOfTwoSignalsStopsTheForces) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) {
      const auto both = [=] {
        const StopListener listener;
        raise(first);
        trace(stop_requested() == first ? '1' : '?');
        raise(second);
        trace('?');
      };
      EXPECT_EXIT(run(both), KilledBySignal(second), "^1f$") << first;
    }
  }
}

TEST(Signals, AHandlerFromBeforeIsCalledAfterTheForcesStop) {
  const auto install_twice = [] {
    signal(SIGTERM, [](int) { trace('h'); });
    install_signal_handlers();
    install_signal_handlers();
    raise(SIGTERM);
  };
  EXPECT_EXIT(run(install_twice), ExitedWithCode(0), "^fh$");
}

TEST(Signals, AnIgnoredSignalStaysIgnored) {
  const auto ignore = [] {
    signal(SIGHUP, SIG_IGN);
    ignore_broken_pipes();
    const StopListener listener;
    raise(SIGHUP);
    raise(SIGPIPE);
    trace(stop_requested() == 0 ? '1' : '?');
  };
  EXPECT_EXIT(run(ignore), ExitedWithCode(0), "^1$");
}

}  // namespace
}  // namespace palpate
