// Runs the properties of fuzz_checks.h on made data. They abort on a fault, so that a test passes
// if it returns.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/broken_recordings.h"
#include "tests/support/fuzz_checks.h"

namespace palpate::test {
namespace {

// Frames in noise that often starts like a frame.
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

// Streams of a hundred reports of the right length, some of them shorter or longer.
TEST(HidReportsFuzz, HoldsForReportsOfRandomBytes) {
  constexpr std::uint8_t kLengths[] = {64, 25, 7};
  RandomStream random(1, 0);
  std::size_t reports = 0;
  for (std::uint8_t kind = 0; kind < 8; ++kind) {
    for (int stream = 0; stream < 50; ++stream) {
      std::vector<std::uint8_t> data = {kind};
      for (int i = 0; i < 100; ++i) {
        const bool odd = random.index(10) == 0;
        const auto length = odd ? static_cast<std::uint8_t>(random.index(80)) : kLengths[kind % 3];
        data.push_back(length);
        data.push_back(static_cast<std::uint8_t>(random.index(256)));
        // Mostly zeros, because random bytes are hardly ever a valid report of an OpenFFBoard.
        for (int byte = 0; byte < length; ++byte) {
          const bool zero = kind % 3 != 0 && byte > 8;
          data.push_back(zero ? std::uint8_t{0} : static_cast<std::uint8_t>(random.next() & 0xFF));
        }
        if (kind % 3 == 1 && length == 25) data[data.size() - 25] = 0xA1;
        if (kind % 3 == 2 && length == 7) data[data.size() - 7] = 1;
      }
      reports += check_hid_reports(data.data(), data.size());
    }
  }
  EXPECT_EQ(reports, 40'000u);
}

void check(const std::string& text) {
  check_recording(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

TEST(RecordingFuzz, HoldsForEveryBrokenFile) {
  for (const BrokenRecording& broken : broken_recordings()) check(broken.text);
}

TEST(RecordingFuzz, HoldsForAGoodFileCutAnywhere) {
  const std::string text = good_recording();
  for (std::size_t size = 0; size <= text.size(); ++size) check(text.substr(0, size));
}

TEST(RecordingFuzz, HoldsForAGoodFileWithAnyByteChanged) {
  const std::string text = good_recording();
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char byte : {'\0', '\n', '\r', ',', '"', ';', '#', '-', 'e', '\xFF'}) {
      std::string changed = text;
      changed[at] = byte;
      check(changed);
    }
  }
}

}  // namespace
}  // namespace palpate::test
