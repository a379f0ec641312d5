// The advice if the system refuses real-time priority.
#include "engine/live/rt_thread.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <thread>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(RtThread, SaysWhatWasObtained) {
  RtStatus status;
  std::thread([&] { status = make_this_thread_realtime(1, false); }).join();
  EXPECT_EQ(status.scheduling, status.realtime ? "SCHED_FIFO 1" : "normal");
  EXPECT_EQ(status.fix.empty(), status.realtime);
  EXPECT_EQ(realtime_advice(0, 0, false), "");
}

TEST(RtThread, ARefusalComesWithTheExactFix) {
  const std::string advice = realtime_advice(EPERM, ENOMEM, false);
  EXPECT_TRUE(
      test::has_parts(advice, {"Operation not permitted", "Cannot allocate memory", "/etc/security/limits.conf"}));
  EXPECT_TRUE(contains(advice, " - rtprio 90\n")) << advice;
  EXPECT_TRUE(contains(advice, " - memlock unlimited\n")) << advice;
  EXPECT_TRUE(contains(advice, "sudo setcap cap_sys_nice,cap_ipc_lock=ep /")) << advice;
}

TEST(RtThread, RootInAContainerIsToldAboutTheContainer) {
  const std::string advice = realtime_advice(EPERM, 0, true);
  EXPECT_TRUE(contains(advice, "--cap-add=SYS_NICE")) << advice;
  EXPECT_FALSE(contains(advice, "setcap cap")) << advice;
  EXPECT_FALSE(contains(advice, "locked memory")) << advice;
}

}  // namespace
}  // namespace palpate
