#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "engine/recording/recording_reader.h"
#include "tests/support/broken_recordings.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

// The message of the parser about `text`, or "accepted".
std::string verdict(const std::string& text) {
  auto parser = RecordingReader::from(std::make_unique<std::istringstream>(text), "rec.csv");
  if (!parser) return parser.error().message;
  RecordingRow rows[7];
  for (;;) {
    const auto count = parser->read(rows, 7);
    if (!count) return count.error().message;
    if (*count == 0) return "accepted";
  }
}

TEST(RecordingMessages, NameThePlaceAndSayWhatToDo) {
  for (const auto& broken : test::broken_recordings()) {
    const std::string message = verdict(broken.text);
    EXPECT_TRUE(test::has_parts(message, {"rec.csv:" + broken.place + ": found ", ", expected ", "; "})) << broken.name;
    EXPECT_TRUE(test::has_parts(message, broken.parts)) << broken.name;
    std::size_t bad_offset = 0;
    EXPECT_TRUE(is_utf8(message, bad_offset)) << broken.name;
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    EXPECT_TRUE(std::none_of(message.begin(), message.end(), is_control)) << broken.name;
  }
}

}  // namespace
}  // namespace palpate
