// Compares only the position, values and advice of a message, so that its wording may change.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace palpate::test {

// Success if `message` contains `parts` in this order.
inline testing::AssertionResult has_parts(const std::string& message, std::initializer_list<std::string> parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = message.find(part, at);
    if (found == std::string::npos) return testing::AssertionFailure() << "no \"" << part << "\" in: " << message;
    at = found + part.size();
  }
  return testing::AssertionSuccess();
}

}  // namespace palpate::test
