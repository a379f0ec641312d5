// The message if the system refuses real-time priority.
#include "engine/live/rt_thread.h"

#include <gtest/gtest.h>

#include <cerrno>

namespace palpate {
namespace {

int granted(int) { return 0; }
int refused(int) { return EPERM; }
int memory_granted() { return 0; }
int memory_refused() { return ENOMEM; }
int slack() { return 0; }
bool root() { return true; }
bool nobody() { return false; }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(RtThread, SaysWhatWasObtained) {
  const RtStatus status = make_this_thread_realtime({70, true}, {granted, memory_granted, slack, nobody});
  EXPECT_TRUE(status.realtime);
  EXPECT_EQ(status.scheduling, "SCHED_FIFO 70");
  EXPECT_EQ(status.fix, "");
}

TEST(RtThread, ARefusalComesWithTheExactFix) {
  const RtStatus status = make_this_thread_realtime({}, {refused, memory_refused, slack, nobody});
  EXPECT_FALSE(status.realtime);
  EXPECT_EQ(status.scheduling, "normal");
  EXPECT_EQ(status.fix.rfind("real-time priority (Operation not permitted) and locked memory (Cannot allocate "
                             "memory) refused; either add these two lines to /etc/security/limits.conf",
                             0),
            0u)
      << status.fix;
  EXPECT_TRUE(contains(status.fix, " - rtprio 90\n")) << status.fix;
  EXPECT_TRUE(contains(status.fix, " - memlock unlimited\n")) << status.fix;
  EXPECT_TRUE(contains(status.fix, "sudo setcap cap_sys_nice,cap_ipc_lock=ep /")) << status.fix;
}

TEST(RtThread, RootInAContainerIsToldAboutTheContainer) {
  const RtStatus status = make_this_thread_realtime({}, {refused, memory_granted, slack, root});
  EXPECT_TRUE(contains(status.fix, "--cap-add=SYS_NICE")) << status.fix;
  EXPECT_FALSE(contains(status.fix, "setcap cap")) << status.fix;
  EXPECT_FALSE(contains(status.fix, "locked memory")) << status.fix;
}

TEST(RtThread, MemoryThatNobodyWantedLockedIsNoComplaint) {
  const RtStatus status = make_this_thread_realtime({70, false}, {granted, memory_refused, slack, nobody});
  EXPECT_EQ(status.fix, "");
}

}  // namespace
}  // namespace palpate
