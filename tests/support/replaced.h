// A good text with something in it made bad.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace palpate::test {

// `text` with its first `from`, which must be in it, as `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

}  // namespace palpate::test
