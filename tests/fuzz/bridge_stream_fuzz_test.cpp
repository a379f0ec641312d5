#include <gtest/gtest.h>

#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/bridge_stream_fuzz.h"

namespace palpate::test {
namespace {

// Frames in noise that often starts like a frame. The function aborts on a fault, so the
// test passes if it returns.
TEST(BridgeStreamFuzz, HoldsForFramesAmongNoise) {
  constexpr std::uint8_t kBeginning[] = {0x50, 0x42, 0x01, 0x49, 0x50, 0x42, 0x02};
  RandomStream random(5, 0);
  std::size_t frames = 0;
  for (int stream = 0; stream < 500; ++stream) {
    std::vector<std::uint8_t> data;
    for (int piece = 0; piece < 40; ++piece) {
      if (random.index(2) == 0) {
        data.insert(data.end(), {0x00, 0xF5, static_cast<std::uint8_t>(random.index(256))});
        continue;
      }
      for (std::size_t i = random.index(12); i > 0; --i) {
        data.push_back(random.index(2) == 0 ? kBeginning[random.index(7)]
                                            : static_cast<std::uint8_t>(random.index(256)));
      }
    }
    frames += check_bridge_stream(data.data(), data.size());
  }
  EXPECT_GT(frames, 9'000u);
}

}  // namespace
}  // namespace palpate::test
