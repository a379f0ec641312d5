// The stop command that is sent when a signal ends the program.
#include "devices/link/device_stop.h"
#include "devices/bridge/bridge_bus.h"
#include "devices/hid/hid_protocols.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "devices/firmware/bridge_protocol.h"
#include "engine/base/signals.h"

namespace palpate {
namespace {

// How a child process with a device ended, and whether the device got the stop
// command.
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
    register_device_stop(pipe_ends[1], kBridgeProtocol.encode_stop());
    end();
    _exit(7);
  }
  close(pipe_ends[1]);
  Ended ended;
  waitpid(child, &ended.status, 0);
  std::uint8_t bytes[bridge::kHostBytes];
  bridge::FromHost out{};
  ended.told = read(pipe_ends[0], bytes, sizeof bytes) == sizeof bytes && bridge::decode(bytes, out) &&
               out.flags == 0 && out.force_uN == 0;
  close(pipe_ends[0]);
  return ended;
}

// Restores default handlers, because nohup starts a program with ignored signals.
void nothing_ignored() {
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) signal(one, SIG_DFL);
}

TEST(DeviceStop, StopsDevicesBeforeASignalEndsTheProgram) {
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
  const Ended ended = run([] { signal(SIGSEGV, SIG_DFL); }, [] { raise(SIGSEGV); });
  EXPECT_TRUE(ended.told);
  EXPECT_TRUE(WIFSIGNALED(ended.status));
}

// Writes reports without pause, each blocked for 2 ms as by a slow device.
void push_without_end(int descriptor) {
  DeviceCommand command;
  command.drive = true;
  command.units = 500;
  const OutReports push = kBridgeProtocol.encode_command(command);
  while (true) {
    if (!begin_force_write()) continue;
    poll(nullptr, 0, 2);
    [[maybe_unused]] const auto written = write(descriptor, push.bytes[0].data(), push.sizes[0]);
    end_force_write();
  }
}

// The last command to the device when a child that renders force all the time got two signals.
Ended run_two_signals(int first, int second) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    nothing_ignored();
    const StopListener listener;
    register_device_stop(ends[1], kBridgeProtocol.encode_stop());
    std::thread([&] { push_without_end(ends[1]); }).detach();
    poll(nullptr, 0, 10);
    raise(first);
    poll(nullptr, 0, 10);
    raise(second);
    _exit(7);
  }
  close(ends[1]);
  Ended ended;
  std::uint8_t bytes[bridge::kHostBytes];
  bridge::FromHost out{};
  int reports = 0;
  for (; read(ends[0], bytes, sizeof bytes) == sizeof bytes; ++reports) {
    ended.told = bridge::decode(bytes, out) && out.flags == 0 && out.force_uN == 0;
  }
  EXPECT_GT(reports, 2);
  close(ends[0]);
  waitpid(child, &ended.status, 0);
  return ended;
}

TEST(DeviceStop, NoForceFollowsTheStopInAnyOrderOfTwoSignals) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      const Ended ended = run_two_signals(first, second);
      EXPECT_TRUE(ended.told) << first << " then " << second;
      EXPECT_TRUE(WIFSIGNALED(ended.status) && WTERMSIG(ended.status) == second) << ended.status;
    }
  }
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
