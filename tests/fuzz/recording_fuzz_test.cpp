#include <gtest/gtest.h>

#include <string>

#include "tests/support/broken_recordings.h"
#include "tests/support/recording_fuzz.h"

namespace palpate::test {
namespace {

void check(const std::string& text) {
  check_recording_bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

// The function aborts on a fault, so the test passes if it returns.
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
