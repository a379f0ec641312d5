// Tests the real libhidapi on an emulated board: find, open, read, write, unplug.
// A separate program, because it runs with the preload library of umockdev.
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "devices/hid/hidapi_bus.h"
#include "devices/link/device_link.h"
#include "engine/base/signals.h"
#include "engine/live/pacer.h"
#include "tests/devices/emulated/emulated_board.h"
#include "tests/support/hid_ticks.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using test::EmulatedBoard;
using test::tick_until;

// The first argument of the program when it is the child process below.
constexpr const char* kPushUntilEnded = "--push-until-ended";

// The child process: renders a force until a signal ends it, and writes a byte to `ready` when it starts.
[[noreturn]] void push_until_ended(int ready) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
  const StopListener listener;
  HidapiBus bus{-1};
  Result<OpenedDevice> opened = open_first(bus, {&kOpenFfBoardProtocol});
  if (!opened) _exit(3);
  LinkedDevice device(bus, test::patient(test::example_calibration(&kOpenFfBoardProtocol)), std::move(*opened));
  if (!device.open()) _exit(4);
  device.start_zeroing();
  tick_until(device, 0.0, [](const DeviceHealth& health) { return health.may_push(); });
  int ticks = 0;
  tick_until(device, 2.0, [&](const DeviceHealth&) {
    if (++ticks == 50 && write(ready, "1", 1) != 1) _exit(5);
    return false;
  });
  _exit(6);
}

class HidEmulated : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const preload = std::getenv("LD_PRELOAD");
    if (preload == nullptr || std::strstr(preload, "umockdev") == nullptr) {
      GTEST_SKIP() << "not run under umockdev (LD_PRELOAD=libumockdev-preload.so.0)";
    }
    // umockdev needs pseudo-terminals for its nodes and aborts without them.
    int ends[2];
    if (openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) != 0) {
      GTEST_SKIP() << "no pseudo-terminals here; mount /dev/pts";
    }
    for (const int end : ends) close(end);
  }
  HidapiBus bus{-1};
};

TEST_F(HidEmulated, IsFoundOpenedAndIdentified) {
  EmulatedBoard board;
  const std::vector<DeviceNode> found = bus.list();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].path, "/dev/hidraw0");
  EXPECT_EQ(found[0].product, "FFBoard");
  EXPECT_EQ(found[0].vendor_id, 0x1209);
  EXPECT_EQ(found[0].product_id, 0xFFB0);
  EXPECT_EQ(found[0].usage_page, 0xFF00);
  EXPECT_EQ(found[0].usage, 1);
  EXPECT_EQ(hid_protocol_of(found[0]), &kOpenFfBoardProtocol);
}

TEST_F(HidEmulated, IsOpenedByOneProgramAtATime) {
  EmulatedBoard board;
  Result<OpenedDevice> first = open_first(bus, {&kOpenFfBoardProtocol});
  ASSERT_TRUE(first.ok());
  EXPECT_TRUE(test::has_parts(bus.open(first->info).error().message, {"/dev/hidraw0", "in use", "; "}));
}

TEST_F(HidEmulated, ReadsAndWritesWholeReports) {
  EmulatedBoard board;
  Result<OpenedDevice> opened = open_first(bus, {&kOpenFfBoardProtocol});
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  std::uint8_t bytes[65] = {};
  ASSERT_EQ(opened->connection->read(bytes, sizeof bytes), 25);
  DeviceReading reading;
  ASSERT_EQ(kOpenFfBoardProtocol.decode(bytes, 25, reading), ReportVerdict::position);
  EXPECT_EQ(reading.counts, 1000);
  const OutReports stop = kOpenFfBoardProtocol.encode_stop();
  ASSERT_TRUE(opened->connection->write(stop.bytes[0].data(), stop.sizes[0]));
  EXPECT_EQ(board.last_write_size, 25u) << "the report id comes first";
  board.gone = true;
  EXPECT_LT(opened->connection->read(bytes, sizeof bytes), 0);
  EXPECT_FALSE(opened->connection->write(stop.bytes[0].data(), stop.sizes[0]));
}

TEST_F(HidEmulated, RendersReleasesAndReportsALoss) {
  EmulatedBoard board;
  const DeviceCalibration calibration = test::patient(test::example_calibration(&kOpenFfBoardProtocol));
  Result<OpenedDevice> opened = open_first(bus, {&kOpenFfBoardProtocol});
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  LinkedDevice device(bus, calibration, std::move(*opened));
  ASSERT_TRUE(device.open().ok());
  device.start_zeroing();
  ASSERT_TRUE(tick_until(device, 0.0, [](const DeviceHealth& health) { return health.may_push(); }));
  EXPECT_TRUE(tick_until(device, 2.0, [&](const DeviceHealth&) { return board.motor_units == -6667.0; }));
  const DeviceHealth health = device.health(steady_now_s());
  std::printf("emulated: age of the sample %.2f ms\n", 1e3 * health.sample_age_s);
  board.gone = true;
  EXPECT_TRUE(
      tick_until(device, 2.0, [](const DeviceHealth& lost) { return (lost.faults & device_fault::kUnplugged) != 0; }));
  board.gone = false;
  EXPECT_TRUE(tick_until(device, 0.0, [](const DeviceHealth& back) {
    return back.faults == device_fault::kUnplugged && back.zeroing == Zeroing::needed;
  }));
  device.start_zeroing();
  EXPECT_TRUE(tick_until(device, 0.0, [](const DeviceHealth& again) { return again.may_push(); }));
  EXPECT_TRUE(tick_until(device, 2.0, [&](const DeviceHealth&) { return board.motor_units == -6667.0; }));
  device.close();
  EXPECT_GT(board.writes, 10);
}

// Whether the board is told to push, within ten seconds: on a busy machine the threads of the child may be late, and
// its force is 0 until they are on time again.
bool is_pushed(const EmulatedBoard& board) {
  for (int i = 0; i < 10'000 && board.told_units != -6667; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return board.told_units == -6667;
}

struct LastForce {
  int units = -1;
  std::chrono::steady_clock::duration took{};  // from the second signal to the end of the child
};

void end_by_two_signals(int first, int second, LastForce& last) {
  EmulatedBoard board;
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const std::string descriptor = std::to_string(ready[1]);
  const pid_t child = fork();
  if (child == 0) {
    // A new program, because a fork inherits locks that other threads (umockdev's) hold.
    execl("/proc/self/exe", "palpate_hid_tests", kPushUntilEnded, descriptor.c_str(), nullptr);
    _exit(2);
  }
  close(ready[1]);
  char byte = 0;
  EXPECT_EQ(read(ready[0], &byte, 1), 1);
  close(ready[0]);
  EXPECT_TRUE(is_pushed(board));
  kill(child, first);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0) << "the first only asks";
  EXPECT_TRUE(is_pushed(board)) << "this program does not answer";
  const auto asked = std::chrono::steady_clock::now();
  kill(child, second);
  int status = 0;
  waitpid(child, &status, 0);
  last.took = std::chrono::steady_clock::now() - asked;
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == second) << status;
  last.units = board.told_units;
}

TEST_F(HidEmulated, ZeroForceIsTheLastReportInAnyOrderOfTwoSignals) {
  // A write that takes longer than this is no longer waited for (devices/link/device_link.cpp). On a USB port it takes
  // a few milliseconds; here another thread answers it, which a busy machine may hold up. Then it is tried again.
  constexpr auto kLongestWrite = std::chrono::milliseconds(20);
  constexpr int kTries = 10;
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP}) {
      LastForce last;
      for (int i = 0; i < kTries && (i == 0 || (last.units != 0 && last.took >= kLongestWrite)); ++i) {
        end_by_two_signals(first, second, last);
      }
      EXPECT_EQ(last.units, 0) << first << " then " << second;
    }
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc == 3 && std::string_view(argv[1]) == kPushUntilEnded) push_until_ended(std::atoi(argv[2]));
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
