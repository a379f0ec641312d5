// What the reader and the writer of model files agree on. Internal to them.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <algorithm>
#include <string>

#include "engine/tick/features.h"
#include "models/model/file/model_json.h"

namespace palpate {

// What is wrong with the name of a model or a method, empty if nothing is. It heads a column of a
// CSV file, so it holds nothing that would break a line into other columns.
inline std::string model_name_fault(const std::string& name) {
  const std::string expected =
      "expected 1 to " + std::to_string(kModelNameBytes) + " bytes without control characters, commas and quotes";
  if (name.empty()) return "found an empty text, " + expected;
  if (name.size() > kModelNameBytes) return "found " + std::to_string(name.size()) + " bytes, " + expected;
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"';
  });
  return plain ? "" : "found a control character, comma or quote, " + expected;
}

}  // namespace palpate
