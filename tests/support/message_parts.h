// Values and error messages of results. Tests compare only position, values and advice of a message, so that its
// wording may change.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace palpate::test {

// Returns the value of `result` or throws its message, which fails the test.
template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

// The message of the error, "accepted" without one.
template <typename T>
std::string message_of(const Result<T>& result) {
  return result ? "accepted" : result.error().message;
}

// Returns `text` with the first `from` replaced by `to`. Without a `from` the test fails.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

// Success if `message` contains `parts` in this order.
inline testing::AssertionResult has_parts(const std::string& message, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = message.find(part, at);
    if (found == std::string::npos) return testing::AssertionFailure() << "no \"" << part << "\" in: " << message;
    at = found + part.size();
  }
  return testing::AssertionSuccess();
}

// Success if `result` has an error with these parts.
template <typename T>
testing::AssertionResult has_parts(const Result<T>& result, const std::vector<std::string>& parts) {
  return has_parts(message_of(result), parts);
}

// A change of a valid text, and the parts of the message about it.
struct BrokenText {
  std::string from;
  std::string to;
  std::vector<std::string> parts;
};

// Expects that `message_of` has the parts for each of these changes of `good`.
template <typename Message>
void expect_messages(const std::string& good, const Message& message_of, const std::vector<BrokenText>& broken) {
  for (const auto& [from, to, parts] : broken)
    EXPECT_TRUE(has_parts(message_of(replaced(good, from, to)), parts)) << from << " replaced by " << to;
}

}  // namespace palpate::test
