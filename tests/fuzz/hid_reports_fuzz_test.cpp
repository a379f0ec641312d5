#include <gtest/gtest.h>

#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/hid_reports_fuzz.h"

namespace palpate::test {
namespace {

// Streams of a hundred reports of the right length, some of them shorter or longer. The
// function aborts on a fault, so the test passes if it returns.
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

}  // namespace
}  // namespace palpate::test
