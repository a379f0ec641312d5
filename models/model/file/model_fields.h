// What the reader and the writer of model files agree on. Internal to them.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "engine/tick/features.h"
#include "models/model/file/model_json.h"

namespace palpate {

inline constexpr std::array<std::string_view, 5> kMethodNames = {"direct", "voxel", "random", "kdtree", "greedy"};

inline bool is_known_method(std::string_view method) {
  return std::find(kMethodNames.begin(), kMethodNames.end(), method) != kMethodNames.end();
}

inline std::string known_methods() {
  std::string names;
  for (const std::string_view name : kMethodNames) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

// What is wrong with a model's name, empty if nothing is. It heads a column of a
// CSV file, so it holds nothing that would break a line into other columns.
inline std::string model_name_fault(const std::string& name) {
  const std::string expected = "expected 1 to " + std::to_string(kModelNameBytes) +
                               " bytes without control characters, commas and quotes";
  if (name.empty()) return "found an empty text, " + expected;
  if (name.size() > kModelNameBytes) return "found " + std::to_string(name.size()) + " bytes, " + expected;
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"';
  });
  return plain ? "" : "found a control character, comma or quote, " + expected;
}

}  // namespace palpate
