// Makes a broken text from a good one.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace palpate::test {

// Returns `text` with the first `from` (which must occur) replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

}  // namespace palpate::test
