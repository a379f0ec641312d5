// Sets of models are passed between threads without being lost, used after
// deletion, or deleted by the tick.
#include "engine/live/model_slot.h"

#include <gtest/gtest.h>

#include <thread>

namespace palpate {
namespace {

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

TEST(ModelSlot, HandsOverTheNewestAndDeletesTheUntaken) {
  {
    ModelSlot<Set> slot;
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.publish(std::make_unique<Set>(1));
    slot.publish(std::make_unique<Set>(2));
    EXPECT_EQ(alive, 1) << "the first was never taken";
    Set* taken = slot.acquire();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->number, 2);
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.retire(taken);
    EXPECT_EQ(alive, 1) << "not by the tick";
    EXPECT_EQ(slot.collect(), 1u);
    EXPECT_EQ(alive, 0);
    slot.publish(std::make_unique<Set>(3));
    slot.retire(slot.acquire());
    slot.publish(std::make_unique<Set>(4));
    EXPECT_EQ(alive, 1) << "publishing collects as well";
  }
  EXPECT_EQ(alive, 0) << "and so does the end";
}

TEST(ModelSlot, KeepsTheOldSetWhileTheRetireRingIsFull) {
  ModelSlot<Set> slot;
  slot.publish(std::make_unique<Set>(0));
  Set* waiting = slot.acquire();
  slot.publish(std::make_unique<Set>(9));
  // Without collect() the ring is full after eight sets.
  for (int i = 1; i <= 8; ++i) slot.retire(new Set(i));
  EXPECT_EQ(slot.acquire(), nullptr) << "no room for the one that would be given up";
  EXPECT_EQ(slot.collect(), 8u);
  Set* taken = slot.acquire();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->number, 9);
  slot.retire(waiting);
  slot.retire(taken);
}

TEST(ModelSlot, UnderStressEverySetIsDeletedOnceAndNeverInTheTick) {
  constexpr int kLast = 20000;
  deleted_in_tick = 0;
  {
    ModelSlot<Set> slot;
    std::atomic<int> wrong{0};
    std::thread haptics([&] {
      in_tick = true;
      Set* current = nullptr;
      while (current == nullptr || current->number < kLast) {
        Set* next = slot.acquire();
        if (next != nullptr) {
          if (current != nullptr) {
            if (next->number <= current->number) ++wrong;
            slot.retire(current);
          }
          current = next;
        }
        if (current != nullptr && current->number != current->number_again) ++wrong;
        if (next == nullptr) std::this_thread::yield();
      }
      slot.retire(current);
      in_tick = false;
    });
    for (int i = 1; i <= kLast; ++i) {
      slot.publish(std::make_unique<Set>(i));
      if (i % 3 == 0) std::this_thread::yield();
    }
    // While the ring is full, the tick cannot take the last set.
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
