#include "engine/base/signals.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>

namespace palpate {
namespace {

int trace_descriptor = -1;

void trace(char letter) { [[maybe_unused]] const auto written = write(trace_descriptor, &letter, 1); }

struct Ended {
  int signal = 0;     // the signal that ended the child; 0: none
  std::string trace;  // f: forces stopped; others: written by the child
};

// Runs `body` in a child process that has forces to stop and default handlers.
Ended in_child(const std::function<void()>& body) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    trace_descriptor = ends[1];
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) signal(number, SIG_DFL);
    stop_forces_by([]() noexcept { trace('f'); });
    install_signal_handlers();
    body();
    _exit(0);
  }
  close(ends[1]);
  Ended ended;
  for (char letter = 0; read(ends[0], &letter, 1) == 1;) ended.trace += letter;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  return ended;
}

TEST(Signals, ForcesStopBeforeASignalEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGABRT}) {
    const Ended ended = in_child([=] { raise(number); });
    EXPECT_EQ(ended.signal, number);
    EXPECT_EQ(ended.trace, "f") << number;
  }
}

TEST(Signals, EveryOrderOfTwoSignalsStopsTheForces) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) {
      const Ended ended = in_child([=] {
        const StopListener listener;
        raise(first);
        trace(stop_requested() == first ? '1' : '?');
        raise(second);
        trace('?');
      });
      EXPECT_EQ(ended.signal, second) << first;
      EXPECT_EQ(ended.trace, "1f") << first << " then " << second;
    }
  }
}

TEST(Signals, OnlyRequestsAreAsked) {
  const Ended ended = in_child([] {
    const StopListener listener;
    raise(SIGQUIT);
  });
  EXPECT_EQ(ended.signal, SIGQUIT);
  EXPECT_EQ(ended.trace, "f");
}

TEST(Signals, AnsweredByNobodyASignalEndsTheProgramAgain) {
  const Ended ended = in_child([] {
    { const StopListener listener; }
    raise(SIGTERM);
  });
  EXPECT_EQ(ended.signal, SIGTERM);
  EXPECT_EQ(ended.trace, "f");
}

TEST(Signals, ANewListenerForgetsTheRequestBefore) {
  const Ended ended = in_child([] {
    {
      const StopListener listener;
      raise(SIGINT);
    }
    trace(stop_requested() == SIGINT ? '1' : '?');
    const StopListener listener;
    trace(stop_requested() == 0 ? '2' : '?');
  });
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.trace, "12");
}

TEST(Signals, AHandlerFromBeforeIsCalledAfterTheForcesStop) {
  const Ended ended = in_child([] {
    signal(SIGTERM, [](int) { trace('h'); });
    install_signal_handlers();
    install_signal_handlers();
    raise(SIGTERM);
  });
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.trace, "fh");
}

TEST(Signals, AnIgnoredSignalStaysIgnored) {
  const Ended ended = in_child([] {
    signal(SIGHUP, SIG_IGN);
    ignore_broken_pipes();
    const StopListener listener;
    raise(SIGHUP);
    raise(SIGPIPE);
    trace(stop_requested() == 0 ? '1' : '?');
  });
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.trace, "1");
}

}  // namespace
}  // namespace palpate
