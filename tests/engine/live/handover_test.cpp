// The exchange of data between two threads. The stress tests also run under the thread sanitizer.
#include "engine/live/handover.h"

#include <gtest/gtest.h>

#include <thread>
#include <utility>

namespace palpate {
namespace {

// A value is torn if its words differ.
struct Words {
  std::array<std::uint64_t, 40> all{};
};

Words words(std::uint64_t value) {
  Words result;
  result.all.fill(value);
  return result;
}

TEST(TripleBuffer, GivesTheNewestOnceAndKeepsIt) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.newest(), 0) << "nothing was written";
  for (int i = 1; i <= 5; ++i) buffer.write(i);
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.value(), 5);
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.value(), 5);
  buffer.write(6);
  EXPECT_EQ(buffer.value(), 5) << "until it is asked to";
  EXPECT_EQ(buffer.newest(), 6);
}

TEST(TripleBuffer, UnderStressIsNeverTornNeverBackwardsAndEndsWithTheNewest) {
  constexpr std::uint64_t kLast = 200000;
  TripleBuffer<Words> buffer;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) buffer.write(words(i));
  });
  std::uint64_t seen = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  while (seen < kLast) {
    const bool fresh = buffer.refresh();
    const Words& value = buffer.value();
    for (const std::uint64_t word : value.all) torn += word != value.all[0] ? 1 : 0;
    if (fresh ? value.all[0] <= seen : value.all[0] != seen) ++backwards;
    seen = value.all[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_FALSE(buffer.refresh());
}

TEST(SpscRing, KeepsOrderAndDropsTheNewWhenFull) {
  SpscRing<int, 4> ring;
  for (int i = 1; i <= 4; ++i) EXPECT_TRUE(ring.push(i));
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
  EXPECT_TRUE(ring.push(7));
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

// A set of models, which counts how many exist and how many the tick deleted.
std::atomic<int> alive{0};
thread_local bool in_tick = false;
std::atomic<int> deleted_in_tick{0};

struct Set {
  explicit Set(int n) : number(n), number_again(n) { ++alive; }
  Set(const Set&) = delete;
  Set& operator=(const Set&) = delete;
  ~Set() {
    --alive;
    if (in_tick) ++deleted_in_tick;
    number = -1;
  }
  int number;
  int number_again;
};

TEST(ModelSlot, HandsOverTheNewestAndDeletesTheOthersOnTheSlowSide) {
  {
    ModelSlot<Set> slot;
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.publish(std::make_unique<Set>(1));
    slot.publish(std::make_unique<Set>(2));
    EXPECT_EQ(alive, 1) << "the first was never taken";
    std::unique_ptr<Set> taken = slot.acquire();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->number, 2);
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.publish(std::make_unique<Set>(3));
    slot.retire(std::move(taken));
    EXPECT_EQ(alive, 2) << "not deleted by the tick";
    EXPECT_EQ(slot.acquire(), nullptr) << "the retired one is not yet deleted";
    EXPECT_TRUE(slot.collect());
    EXPECT_FALSE(slot.collect());
    slot.retire(slot.acquire());
    slot.publish(std::make_unique<Set>(4));
    EXPECT_EQ(alive, 1) << "publishing collects as well";
    slot.retire(slot.acquire());
    slot.publish(std::make_unique<Set>(5));
  }
  EXPECT_EQ(alive, 0) << "and so does the end";
}

TEST(ModelSlot, UnderStressEverySetIsDeletedOnceAndNeverInTheTick) {
  constexpr int kLast = 20000;
  deleted_in_tick = 0;
  {
    ModelSlot<Set> slot;
    std::atomic<int> wrong{0};
    std::thread haptics([&] {
      in_tick = true;
      auto current = std::make_unique<Set>(0);
      while (current->number < kLast) {
        std::unique_ptr<Set> next = slot.acquire();
        if (next == nullptr) {
          std::this_thread::yield();
          continue;
        }
        if (next->number <= current->number || next->number != next->number_again) ++wrong;
        slot.retire(std::exchange(current, std::move(next)));
      }
      in_tick = false;  // the last set is deleted by the end of the thread
    });
    for (int i = 1; i <= kLast; ++i) {
      slot.publish(std::make_unique<Set>(i));
      if (i % 3 == 0) std::this_thread::yield();
    }
    // Until the set before is deleted, the tick cannot take the last one.
    while (alive > 0) {
      slot.collect();
      std::this_thread::yield();
    }
    haptics.join();
    EXPECT_EQ(wrong, 0);
  }
  EXPECT_EQ(alive, 0);
  EXPECT_EQ(deleted_in_tick, 0);
}

}  // namespace
}  // namespace palpate
