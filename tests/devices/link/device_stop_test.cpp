// The stop command that is sent when a signal ends the program.
#include "devices/bridge/bridge_bus.h"
#include "devices/link/device_link.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <thread>

#include "devices/firmware/bridge_protocol.h"
#include "engine/base/signals.h"

namespace palpate {
namespace {

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

// Runs `end` in a child process with a device. With `renders` it renders force all the time and listens for a first
// signal. Checks that `signal` ends the child and that the last command to the device is the stop.
template <typename End>
void expect_stop_before(int signal, bool renders, End end) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    // Default handlers, because nohup starts a program with ignored signals, and sanitizers handle crashes.
    for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGSEGV}) ::signal(one, SIG_DFL);
    std::optional<StopListener> listener;
    if (renders) listener.emplace();
    register_device_stop(ends[1], kBridgeProtocol.encode_stop());
    if (renders) std::thread([&] { push_without_end(ends[1]); }).detach();
    end();
    _exit(7);
  }
  close(ends[1]);
  std::uint8_t bytes[bridge::kHostBytes];
  bridge::FromHost out{};
  int reports = 0;
  for (; read(ends[0], bytes, sizeof bytes) == sizeof bytes; ++reports) ASSERT_TRUE(bridge::decode(bytes, out));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_GT(reports, renders ? 2 : 0);
  EXPECT_TRUE(out.flags == 0 && out.force_uN == 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
}

TEST(DeviceStop, StopsDevicesBeforeASignalOrACrashEndsTheProgram) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT}) {
    SCOPED_TRACE(signal);
    expect_stop_before(signal, false,
                       [signal] { signal == SIGABRT ? std::abort() : static_cast<void>(raise(signal)); });
  }
}

TEST(DeviceStop, NoForceFollowsTheStopInAnyOrderOfTwoSignals) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      SCOPED_TRACE(std::to_string(first) + " then " + std::to_string(second));
      expect_stop_before(second, true, [first, second] {
        poll(nullptr, 0, 10);
        raise(first);
        poll(nullptr, 0, 10);
        raise(second);
      });
    }
  }
}

TEST(DeviceStop, HoldsEightDevices) {
  int slots[9];
  for (int& slot : slots) slot = register_device_stop(0, {});
  EXPECT_EQ(slots[8], -1);
  for (const int slot : slots) unregister_device_stop(slot);
  const int again = register_device_stop(0, {});
  EXPECT_GE(again, 0);
  unregister_device_stop(again);
}

}  // namespace
}  // namespace palpate
