// What goes out when a signal ends the program.
#include "devices/hid/hid_drivers.h"
#include "devices/hid/device_stop.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "devices/firmware/paddle/paddle_protocol.h"

namespace palpate {
namespace {

// Runs `end` in a child that holds a device; how it ended, and whether the device
// was told to stop.
struct Ended {
  int status = 0;
  bool told = false;
};

Ended run(void (*before)(), void (*end)()) {
  int pipe_ends[2];
  EXPECT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    before();
    register_device_stop(pipe_ends[1], kPaddleDriver.encode_stop());
    stop_devices_on_signals();
    end();
    _exit(7);
  }
  close(pipe_ends[1]);
  Ended ended;
  waitpid(child, &ended.status, 0);
  std::uint8_t bytes[65];
  paddle::FromHost out{};
  ended.told = read(pipe_ends[0], bytes, sizeof bytes) == 65 &&
               paddle::decode(bytes + 1, out) == paddle::kGood && out.flags == 0 && out.current_mA == 0;
  close(pipe_ends[0]);
  return ended;
}

// A test program that was started with nohup ignores some signals.
void nothing_ignored() {
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) signal(one, SIG_DFL);
}

// Handlers are installed once in a process, and a test before this one may have
// opened a device; CTest runs each on its own.
bool installed_already() {
  struct sigaction action {};
  sigaction(SIGABRT, nullptr, &action);
  return (action.sa_flags & SA_SIGINFO) != 0;
}

TEST(DeviceStop, StopsDevicesBeforeASignalEndsTheProgram) {
  if (installed_already()) GTEST_SKIP() << "the handlers are installed already";
  for (const auto& [signal, end] : {std::pair<int, void (*)()>{SIGINT, [] { raise(SIGINT); }},
                                    {SIGTERM, [] { raise(SIGTERM); }},
                                    {SIGHUP, [] { raise(SIGHUP); }},
                                    {SIGABRT, [] { std::abort(); }}}) {
    const Ended ended = run(nothing_ignored, end);
    EXPECT_TRUE(ended.told) << signal;
    EXPECT_TRUE(WIFSIGNALED(ended.status)) << signal;
    EXPECT_EQ(WTERMSIG(ended.status), signal);
  }
}

TEST(DeviceStop, StopsDevicesInACrash) {
  if (installed_already()) GTEST_SKIP() << "the handlers are installed already";
  const Ended ended = run([] { signal(SIGSEGV, SIG_DFL); }, [] { raise(SIGSEGV); });
  EXPECT_TRUE(ended.told);
  EXPECT_TRUE(WIFSIGNALED(ended.status));
}

TEST(DeviceStop, GoesOnWithTheHandlerThatWasThere) {
  if (installed_already()) GTEST_SKIP() << "the handlers are installed already";
  const Ended ended = run([] { signal(SIGINT, [](int) { _exit(3); }); }, [] { raise(SIGINT); });
  EXPECT_TRUE(ended.told);
  EXPECT_EQ(WEXITSTATUS(ended.status), 3);
}

TEST(DeviceStop, AnIgnoredSignalStaysIgnored) {
  if (installed_already()) GTEST_SKIP() << "the handlers are installed already";
  const Ended ended = run([] { signal(SIGHUP, SIG_IGN); }, [] { raise(SIGHUP); });
  EXPECT_FALSE(ended.told);
  EXPECT_EQ(WEXITSTATUS(ended.status), 7);
}

TEST(DeviceStop, HoldsEightDevices) {
  int slots[9];
  for (int& slot : slots) slot = register_device_stop(-1, {});
  EXPECT_EQ(slots[8], -1);
  for (const int slot : slots) unregister_device_stop(slot);
  const int again = register_device_stop(-1, {});
  EXPECT_GE(again, 0);
  unregister_device_stop(again);
}

}  // namespace
}  // namespace palpate
