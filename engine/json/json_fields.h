// Typed reading of an untrusted JSON text: models, scenes, JND files, calibrations.
// Each access says where it failed, what was found and what was expected:
//   path:line:column: field[index].field: found X, expected Y; what to do
// All errors of a file are collected; a fault that follows from one already told is not.
//
// Thread guarantee: one thread per object; slow side (allocates).
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// What to do, as messages end; begins with "; " or is empty.
struct JsonAdvice {
  std::string field;    // a field is not as it should be
  std::string damaged;  // the text cannot have been written as it is
};

// The document in `text`, with lists and objects at most `nesting` deep. Errors:
// not JSON, deeper, a NUL byte, a name twice in one object, a number beyond the range of a double; with
// path:line:column.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int nesting,
                                  const JsonAdvice& advice);

// "found 3.5", "found a list of 7": what stands there, short enough for a message.
std::string found(const nlohmann::json& value);

enum class Sign { kAny, kNotNegative, kPositive };

// The numbers that a field may hold, both ends included unless `open`: then not `low`.
struct NumberRange {
  double low = 0.0;
  double high = 1.0;
  bool open = false;

  bool holds(double number) const noexcept { return (open ? number > low : number >= low) && number <= high; }
  // "a number above 0 up to 100"
  std::string words() const;
};

// A value and the way to it from the top; no value when it was not there.
struct JsonNode {
  const nlohmann::json* value = nullptr;
  std::string pointer;
};

// Every method complains when it does not find what it wants and then returns
// something harmless; `error` holds all complaints, a line each.
class JsonFields {
 public:
  // `text`: what the document was parsed from; kept by the caller, as `path`.
  JsonFields(std::string_view text, const std::string& path, std::string advice)
      : text_(text), path_(path), advice_(std::move(advice)) {}

  // Up to 20 lines, and how many more there are; nothing while all is well.
  std::optional<Error> error() const;
  std::size_t error_count() const noexcept { return error_count_; }

  // Adds a line about the value at `pointer`, unless one stands there about it or about
  // what it is part of.
  void complain(const std::string& pointer, const std::string& words, const std::string& advice);
  void complain(const std::string& pointer, const std::string& words) { complain(pointer, words, advice_); }

  // The member `key`; `expected` describes it for the case that it is missing.
  JsonNode member(const JsonNode& object, const char* key, const std::string& expected);
  // The same for a member that may be left out: then no complaint.
  JsonNode optional_member(const JsonNode& object, const char* key);
  // A list; without one, complains and gives a JsonNode without value.
  JsonNode list(const JsonNode& object, const char* key, const std::string& expected);
  static JsonNode entry(const JsonNode& list, std::size_t index);

  std::string text(const JsonNode& object, const char* key);
  // One that is not empty.
  std::string filled_text(const JsonNode& object, const char* key);
  bool boolean(const JsonNode& object, const char* key);
  std::uint64_t count(const JsonNode& object, const char* key);
  double number(const JsonNode& object, const char* key, Sign sign = Sign::kAny);
  double number(const JsonNode& object, const char* key, const NumberRange& range);
  // The index in `names` of the text; complains with all of them, and returns nothing.
  std::optional<std::size_t> choice(const JsonNode& node, const std::vector<std::string>& names);

  // Exactly `expected_count` numbers (`words` says which) into `values`.
  bool fill(const JsonNode& node, std::size_t expected_count, const std::string& words, double* values);

  // At the end, when all that may be there was asked for: complains of every member of
  // an object that was not, with those that were.
  void refuse_unknown(const JsonNode& top);

 private:
  template <typename Good>
  const nlohmann::json* value_where(const JsonNode& object, const char* key, const std::string& expected,
                                    const Good& good);
  double number_in(const JsonNode& object, const char* key, const std::string& expected, double instead,
                   const NumberRange& range);
  bool told_already(const std::string& pointer) const;
  std::string_view text_;
  const std::string& path_;
  std::string advice_;
  std::vector<std::string> lines_;
  std::vector<std::string> told_;  // pointers
  std::size_t error_count_ = 0;
  std::map<std::string, std::vector<std::string>> asked_;  // keys by the pointer of their object
};

}  // namespace palpate
