// Typed access to untrusted JSON text: models, scenes, JND files, calibrations. All errors of a file are collected,
// except those that follow from an earlier one: path:line:column: field[index].field: found X, expected Y; what to do
// Thread guarantee: one thread per object; slow side (allocates).
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// The advice at the end of messages; begins with "; " or is empty.
struct JsonAdvice {
  std::string field;    // for a wrong field
  std::string damaged;  // for text that no program of Palpate has written
};

// Parses `text`, with lists and objects nested at most `nesting` deep. Errors, with path:line:column: not JSON, deeper
// nesting, a NUL byte, a name twice in one object, a number beyond the range of a double.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int nesting,
                                  const JsonAdvice& advice);

// "found 3.5", "found a list of 7": a short description of a value for a message.
std::string found(const nlohmann::json& value);

inline constexpr double kLargestNumber = std::numeric_limits<double>::max();

// The range of a number, both ends included; without the lower end if `open`.
struct NumberRange {
  double low = -kLargestNumber, high = kLargestNumber;
  bool open = false;

  bool holds(double number) const noexcept { return (open ? number > low : number >= low) && number <= high; }
  // "a number above 0 up to 100", "a number, 0 or more"
  std::string words() const;
};
inline constexpr NumberRange kNotNegative{0.0};

// A value and its JSON pointer; `value` is null if it does not exist.
struct JsonNode {
  const nlohmann::json* value = nullptr;
  std::string pointer;
};

// Every reading method reports an error if it does not find what it expects, and then returns a default (a number: one
// of the range). `error` returns all errors, one a line.
class JsonFields {
 public:
  // `text`: the document. `advice`: end of each message, as JsonAdvice::field. `text` and `path` must outlive this.
  JsonFields(std::string_view text, const std::string& path, std::string advice)
      : text_(text), path_(path), advice_(std::move(advice)) {}

  // Up to 20 lines, and the number of further errors; none without an error.
  std::optional<Error> error() const;
  std::size_t error_count() const noexcept { return error_count_; }

  // Reports an error of the value at `pointer`, unless this value or one that contains it has an error already.
  void complain(const std::string& pointer, const std::string& words, const std::string& advice);
  void complain(const std::string& pointer, const std::string& words) { complain(pointer, words, advice_); }

  // The member `key`. `expected`: its description for the error if it is missing.
  JsonNode member(const JsonNode& object, const char* key, const std::string& expected);
  // The same for an optional member: no error if it is missing.
  JsonNode optional_member(const JsonNode& object, const char* key);
  // A list; if there is none, reports an error and returns a JsonNode without value.
  JsonNode list(const JsonNode& object, const char* key, const std::string& expected);
  static JsonNode entry(const JsonNode& list, std::size_t index);

  std::string text(const JsonNode& object, const char* key);
  // A text that is not empty.
  std::string filled_text(const JsonNode& object, const char* key);
  bool boolean(const JsonNode& object, const char* key);
  std::uint64_t count(const JsonNode& object, const char* key);
  double number(const JsonNode& object, const char* key, const NumberRange& range = {});
  // The index of the text in `names`; none, after an error that lists the names, if it is not among them.
  std::optional<std::size_t> choice(const JsonNode& node, const std::vector<std::string>& names);

  // Reads exactly `expected_count` numbers within `range` into `values`. `words`: what messages call them.
  bool fill(const JsonNode& node, std::size_t expected_count, const std::string& words, double* values,
            const NumberRange& range = {});

  // To be called after all members have been read: reports an error for every member that was not requested, in all
  // objects from which a member was.
  void refuse_unknown(const JsonNode& top);

 private:
  template <typename Good>
  const nlohmann::json* value_where(const JsonNode& object, const char* key, const std::string& expected,
                                    const Good& good);

  std::string_view text_;
  const std::string& path_;
  std::string advice_;
  std::vector<std::string> lines_;
  std::vector<std::string> reported_;  // pointers of reported errors
  std::size_t error_count_ = 0;
  std::map<std::string, std::vector<std::string>> requested_;  // keys, by the pointer of their object
};

}  // namespace palpate
