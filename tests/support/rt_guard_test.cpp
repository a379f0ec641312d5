#include "tests/support/rt_guard.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace palpate::test {
namespace {

// Prevents the compiler from removing an unused allocation.
void* volatile sink;

void* keep(void* block) {
  sink = block;
  return block;
}

class RtGuardTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc and the locks in this build";
  }
};

RtOffences offences_of(const std::function<void()>& deed) {
  RtGuard guard;
  deed();
  return guard.stop();
}

TEST_F(RtGuardTest, FindsNothingInPlainArithmetic) {
  volatile double value = 1.0;
  EXPECT_EQ(offences_of([&] { value = value * 2.0 + 1.0; }).total(), 0);
}

TEST_F(RtGuardTest, CountsEveryWayToAllocateAndFree) {
  const auto both = [](const std::function<void()>& deed) {
    const RtOffences found = offences_of(deed);
    EXPECT_GE(found.allocations, 1);
    EXPECT_GE(found.deallocations, 1);
    EXPECT_EQ(found.locks + found.sleeps + found.writes, 0);
  };
  both([] { free(keep(malloc(10))); });
  both([] { free(keep(calloc(10, 10))); });
  both([] { free(keep(realloc(nullptr, 10))); });
  both([] { free(keep(aligned_alloc(64, 128))); });
  both([] {
    void* block = nullptr;
    EXPECT_EQ(posix_memalign(&block, 64, 100), 0);
    free(keep(block));
  });
  both([] {
    const auto value = std::make_unique<int>(1);
    sink = value.get();
  });
  both([] {
    struct alignas(64) Wide {
      char bytes[64];
    };
    const auto value = std::make_unique<Wide>();
    sink = value.get();
  });
  both([] {
    std::vector<double> values(100);
    sink = values.data();
  });
}

TEST_F(RtGuardTest, CountsAThrownException) {
  const RtOffences found = offences_of([] {
    try {
      throw std::runtime_error("inside the tick");
    } catch (const std::exception&) {
    }
  });
  EXPECT_GE(found.allocations, 1);
}

TEST_F(RtGuardTest, CountsALock) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  const RtOffences found = offences_of([&] {
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
  });
  EXPECT_EQ(found.locks, 1);
}

TEST_F(RtGuardTest, CountsASleepAndAWrite) {
  const RtOffences found = offences_of([] {
    const timespec moment{0, 1};
    clock_nanosleep(CLOCK_MONOTONIC, 0, &moment, nullptr);
    EXPECT_EQ(write(STDOUT_FILENO, "", 0), 0);
  });
  EXPECT_EQ(found.sleeps, 1);
  EXPECT_EQ(found.writes, 1);
}

TEST_F(RtGuardTest, IgnoresFreeOfNothing) {
  EXPECT_EQ(offences_of([] { free(nullptr); }).total(), 0);
}

TEST_F(RtGuardTest, CountsThisThreadUntilStop) {
  std::thread other;
  RtGuard guard;
  const RtOffences first = guard.stop();
  other = std::thread([] { sink = std::make_unique<int>(1).get(); });
  other.join();
  EXPECT_EQ(first.total(), 0);
  EXPECT_EQ(guard.stop().total(), 0);
}

}  // namespace
}  // namespace palpate::test
