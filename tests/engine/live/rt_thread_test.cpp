// The advice if the system refuses real-time priority.
#include "engine/live/pacer.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <thread>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(RtThread, SaysWhatWasObtained) {
  RtStatus status;
  std::thread([&] { status = make_this_thread_realtime(1, false); }).join();
  EXPECT_EQ(status.scheduling, status.realtime ? "SCHED_FIFO 1" : "normal");
  EXPECT_EQ(status.fix.empty(), status.realtime);
  EXPECT_EQ(realtime_advice(0, 0, false), "");
}

TEST(RtThread, ARefusalComesWithTheExactFix) {
  const std::string advice = realtime_advice(EPERM, ENOMEM, false);
  EXPECT_TRUE(test::has_parts(
      advice, {"Operation not permitted", "Cannot allocate memory", "/etc/security/limits.conf", " - rtprio 90\n",
               " - memlock unlimited\n", "sudo setcap cap_sys_nice,cap_ipc_lock=ep /"}));
}

TEST(RtThread, RootInAContainerIsToldAboutTheContainer) {
  const std::string advice = realtime_advice(EPERM, 0, true);
  EXPECT_TRUE(test::has_parts(advice, {"--cap-add=SYS_NICE"}));
  EXPECT_FALSE(test::has_parts(advice, {"setcap cap"}));
  EXPECT_FALSE(test::has_parts(advice, {"locked memory"}));
}

}  // namespace
}  // namespace palpate
