// A reader gets the newest complete value, never an older one after a newer one.
#include "engine/live/triple_buffer.h"

#include <gtest/gtest.h>

#include <thread>

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

TEST(TripleBuffer, GivesTheFirstValueUntilOneIsWritten) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.value(), 7);
  EXPECT_EQ(buffer.newest(), 7);
}

TEST(TripleBuffer, GivesTheNewestOnceAndKeepsIt) {
  TripleBuffer<int> buffer;
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

}  // namespace
}  // namespace palpate
