// Every value arrives in order or is counted as dropped.
#include "engine/live/spsc_ring.h"

#include <gtest/gtest.h>

#include <thread>

namespace palpate {
namespace {

TEST(SpscRing, KeepsOrderAndDropsTheNewWhenFull) {
  SpscRing<int, 4> ring;
  for (int i = 1; i <= 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.has_room());
  EXPECT_FALSE(ring.push(5));
  EXPECT_FALSE(ring.push(6));
  EXPECT_EQ(ring.dropped(), 2u);
  int value = 0;
  for (int i = 1; i <= 4; ++i) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(value, 4) << "as it was";
  EXPECT_TRUE(ring.has_room());
}

TEST(SpscRing, HandsOutManyAcrossItsEnd) {
  SpscRing<int, 8> ring;
  std::array<int, 16> values{};
  for (int i = 0; i < 6; ++i) ring.push(i);
  EXPECT_EQ(ring.pop(values.data(), 5), 5u);
  for (int i = 6; i < 13; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_EQ(ring.pop(values.data(), values.size()), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(values[static_cast<std::size_t>(i)], i + 5);
}

TEST(SpscRing, UnderStressLosesOnlyWhatItCounts) {
  constexpr std::uint64_t kLast = 300000;
  struct Pair {
    std::uint64_t value = 0;
    std::uint64_t again = 0;
  };
  SpscRing<Pair, 64> ring;
  std::uint64_t sent = 0;
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) sent += ring.push({i, i}) ? 1 : 0;
    // Retries the last value until it is accepted.
    while (!ring.push({kLast + 1, kLast + 1})) std::this_thread::yield();
    ++sent;
  });
  std::array<Pair, 10> values;
  std::uint64_t received = 0;
  std::uint64_t wrong = 0;
  std::uint64_t last = 0;
  while (last <= kLast) {
    const std::size_t count = ring.pop(values.data(), values.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (values[i].value != values[i].again || values[i].value <= last) ++wrong;
      last = values[i].value;
    }
    received += count;
    if (count == 0) std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(received, sent);
  EXPECT_GE(ring.dropped() + sent, kLast + 1) << "the last one may have been dropped several times";
}

}  // namespace
}  // namespace palpate
