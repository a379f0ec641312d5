// Typed reading of an untrusted JSON text: each access says where it failed, what
// was found and what was expected. Internal to the model reader.
//
// Thread guarantee: one thread per object; slow side (allocates).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

// Closes every message about a file that cannot have been written as it is.
inline constexpr const char* kDamaged = "; the file is damaged: copy it again or fit the model again";

// The document in `text`, with lists and objects at most `nesting` deep. Errors:
// not JSON, deeper, a number beyond the range of a double; with
// path:line:column.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int nesting);

// "found 3.5", "found a list of 7": what stands there, short enough for a message.
std::string found(const nlohmann::json& value);

enum class Sign { kAny, kNotNegative, kPositive };

// A value and the way to it from the top; no value when it was not there.
struct JsonNode {
  const nlohmann::json* value = nullptr;
  std::string pointer;
};

// Every method complains when it does not find what it wants and then returns
// something harmless; `error` keeps the first complaint.
class JsonFields {
 public:
  // `text`: what the document was parsed from; kept by the caller, as `path`.
  JsonFields(std::string_view text, const std::string& path, std::string advice)
      : text_(text), path_(path), advice_(std::move(advice)) {}

  const std::optional<Error>& error() const { return error_; }

  // "path:line:column: field[index]: words", then what to do.
  void complain(const std::string& pointer, const std::string& words, const std::string& advice);
  void complain(const std::string& pointer, const std::string& words) { complain(pointer, words, advice_); }

  // The member `key`; `expected` describes it for the case that it is missing.
  JsonNode member(const JsonNode& object, const char* key, const std::string& expected);
  JsonNode list(const JsonNode& object, const char* key, const std::string& expected);

  std::string text(const JsonNode& object, const char* key);
  bool boolean(const JsonNode& object, const char* key);
  std::uint64_t count(const JsonNode& object, const char* key);
  double number(const JsonNode& object, const char* key, Sign sign = Sign::kAny);

  // Exactly `expected_count` numbers (`words` says which) into `values`.
  bool fill(const JsonNode& node, std::size_t expected_count, const std::string& words, double* values);

 private:
  std::string_view text_;
  const std::string& path_;
  std::string advice_;
  std::optional<Error> error_;
};

}  // namespace palpate
