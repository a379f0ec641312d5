#include "engine/json/json_fields.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/text.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostLines = 20;

// A bracket, a comma, a colon, a text with its quotes, or another value.
struct Token {
  char kind = '\0';  // its first character; 0 at the end
  std::size_t begin = 0;
  std::string_view content;

  bool opens() const { return kind == '{' || kind == '['; }
  bool closes() const { return kind == '}' || kind == ']'; }
};

// The first token from `at` on. The text need not be valid.
Token token_at(std::string_view text, std::size_t at) {
  constexpr std::string_view kMarks = "{}[],:";
  const std::size_t begin = text.find_first_not_of(" \t\r\n", at);
  if (begin == std::string_view::npos) return {'\0', text.size(), {}};
  std::size_t end = begin + 1;
  if (text[begin] == '"') {
    while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2u : 1u;
    ++end;
  } else if (kMarks.find(text[begin]) == std::string_view::npos) {
    end = text.find_first_of("{}[],:\" \t\r\n", end);
  }
  return {text[begin], begin, text.substr(begin, end - begin)};
}

Token token_after(std::string_view text, const Token& token) {
  return token_at(text, token.begin + token.content.size());
}

bool is_name(std::string_view text, const Token& token) {
  return token.kind == '"' && token_after(text, token).kind == ':';
}

// The offset of the value at a JSON pointer such as "/features/2/kind" ("": the whole document) in valid JSON. A
// missing value has the offset of the deepest existing value on its path. Keys with escapes are not found.
std::size_t offset_of_value(std::string_view text, const std::string& pointer) {
  struct Level {
    std::string prefix;  // the pointer of the object or list, and a slash
    bool is_list;
    std::string name;       // of the next member
    std::size_t index = 0;  // of the next element
  };
  std::vector<Level> open;
  std::size_t offset = 0;
  for (Token token = token_at(text, 0); token.kind != '\0'; token = token_after(text, token)) {
    if (token.closes()) {
      open.pop_back();
    } else if (is_name(text, token)) {
      open.back().name = token.content.substr(1, token.content.size() - 2);  // without quotes
    } else if (token.kind != ',' && token.kind != ':') {
      std::string here;
      if (!open.empty()) {
        Level& level = open.back();
        here = level.prefix + (level.is_list ? std::to_string(level.index++) : level.name);
      }
      if (here == pointer) return token.begin;
      if (pointer.starts_with(here + "/")) offset = token.begin;
      if (token.opens()) open.push_back({here + "/", token.kind == '[', {}});
    }
  }
  return offset;
}

// The first number beyond the range of a double, in text that is valid up to there.
Token too_large_number(std::string_view text) {
  Token token = token_at(text, 0);
  for (; token.kind != '\0'; token = token_after(text, token)) {
    const bool is_number = token.kind == '-' || (token.kind >= '0' && token.kind <= '9');
    if (is_number && Json::parse(token.content, nullptr, false).is_discarded()) break;
  }
  return token;
}

// "/centres/3" as "centres[3]", "/domain/points" as "domain.points".
std::string field_name(std::string_view pointer) {
  std::string name;
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    const std::string step(pointer.substr(0, end));
    const bool index = !step.empty() && step.find_first_not_of("0123456789") == std::string::npos;
    name.append(index ? "[" : name.empty() ? "" : ".").append(index ? step + "]" : printable(step));
    pointer.remove_prefix(end);
  }
  return name;
}

// No range contains a non-finite number.
bool is_number_of(const Json& value, const NumberRange& range) {
  return value.is_number() && range.holds(value.get<double>());
}

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& path, int nesting, const JsonAdvice& advice) {
  const auto wrong = [&](std::size_t offset, const std::string& words, const std::string& what_to_do) {
    return Error{position_prefix(path, text, offset) + words + what_to_do};
  };
  // Found before the parser runs: it would need memory for each level, and keep the last of two equal names.
  std::vector<std::set<std::string_view>> open;  // the names in each open object or list
  for (Token token = token_at(text, 0); token.kind != '\0'; token = token_after(text, token)) {
    if (token.closes() && !open.empty()) open.pop_back();
    if (token.opens()) open.emplace_back();
    if (open.size() > static_cast<std::size_t>(nesting)) {
      return wrong(token.begin,
                   "found more than " + std::to_string(nesting) + " lists inside each other, expected fewer",
                   advice.damaged);
    }
    if (is_name(text, token) && !open.empty() && !open.back().insert(token.content).second)
      return wrong(token.begin, "found a name for the second time in one object, expected it once", advice.damaged);
  }
  // The parser treats a NUL as the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos)
    return wrong(nul, "found a NUL byte, expected text", advice.damaged);
  try {
    return Json::parse(text);
  } catch (const Json::out_of_range&) {
    const Token number = too_large_number(text);
    return wrong(number.begin, "found " + printable(number.content) + ", expected a finite number", advice.field);
  } catch (const Json::parse_error& fault) {
    std::string what = fault.what();
    const std::size_t detail = what.find("syntax error");
    if (detail != std::string::npos) what = what.substr(detail);
    return wrong(fault.byte > 0 ? fault.byte - 1 : 0, printable(what, 200), advice.damaged);
  }
}

std::string found(const Json& value) {
  if (value.is_array()) return "found a list of " + std::to_string(value.size());
  if (value.is_object()) return "found an object";
  return "found " + printable(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string NumberRange::words() const {
  if (low == -kLargestNumber && high == kLargestNumber) return "a number";
  const std::string least = general(low, 6);
  if (high == kLargestNumber) return open ? "a number above " + least : "a number, " + least + " or more";
  return std::string("a number ") + (open ? "above " : "from ") + least + " up to " + general(high, 6);
}

std::optional<Error> JsonFields::error() const {
  if (error_count_ == 0) return std::nullopt;
  std::string all = joined(lines_, "\n");
  if (error_count_ > lines_.size())
    all += "\n" + path_ + ": and " + std::to_string(error_count_ - lines_.size()) + " more";
  return Error{all};
}

void JsonFields::complain(const std::string& pointer, const std::string& words, const std::string& advice) {
  const auto contains = [&](const std::string& reported) {
    return pointer == reported || (!reported.empty() && pointer.starts_with(reported + "/"));
  };
  if (std::ranges::any_of(reported_, contains)) return;
  ++error_count_;
  if (lines_.size() == kMostLines) return;
  reported_.push_back(pointer);
  const std::string name = field_name(pointer);
  lines_.push_back(position_prefix(path_, text_, offset_of_value(text_, pointer)) + (name.empty() ? "" : name + ": ") +
                   words + advice);
}

JsonNode JsonFields::optional_member(const JsonNode& object, const char* key) {
  const std::string pointer = object.pointer + "/" + key;
  if (object.value == nullptr || !object.value->is_object()) return {nullptr, pointer};
  std::vector<std::string>& asked = requested_[object.pointer];
  if (std::find(asked.begin(), asked.end(), key) == asked.end()) asked.emplace_back(key);
  const auto entry = object.value->find(key);
  return {entry != object.value->end() ? &*entry : nullptr, pointer};
}

JsonNode JsonFields::member(const JsonNode& object, const char* key, const std::string& expected) {
  if (object.value != nullptr && !object.value->is_object())
    complain(object.pointer, found(*object.value) + ", expected an object with \"" + key + "\"");
  const JsonNode node = optional_member(object, key);
  if (node.value == nullptr && object.value != nullptr && object.value->is_object())
    complain(node.pointer, "found no such field, expected " + expected);
  return node;
}

JsonNode JsonFields::entry(const JsonNode& list, std::size_t index) {
  return {&(*list.value)[index], list.pointer + "/" + std::to_string(index)};
}

// Returns the member if `good` accepts it; otherwise reports an error and returns null.
template <typename Good>
const Json* JsonFields::value_where(const JsonNode& object, const char* key, const std::string& expected,
                                    const Good& good) {
  const JsonNode node = member(object, key, expected);
  if (node.value == nullptr || std::invoke(good, *node.value)) return node.value;
  complain(node.pointer, found(*node.value) + ", expected " + expected);
  return nullptr;
}

std::string JsonFields::text(const JsonNode& object, const char* key) {
  const Json* value = value_where(object, key, "a text", &Json::is_string);
  return value != nullptr ? value->get<std::string>() : std::string();
}

bool JsonFields::boolean(const JsonNode& object, const char* key) {
  const Json* value = value_where(object, key, "true or false", &Json::is_boolean);
  return value != nullptr && value->get<bool>();
}

std::uint64_t JsonFields::count(const JsonNode& object, const char* key) {
  const Json* value = value_where(object, key, "a whole number, 0 or more", &Json::is_number_unsigned);
  return value != nullptr ? value->get<std::uint64_t>() : 0;
}

std::string JsonFields::filled_text(const JsonNode& object, const char* key) {
  const Json* value = value_where(object, key, "a text that is not empty",
                                  [](const Json& one) { return one.is_string() && one != ""; });
  return value != nullptr ? value->get<std::string>() : std::string();
}

double JsonFields::number(const JsonNode& object, const char* key, const NumberRange& range) {
  const Json* value =
      value_where(object, key, range.words(), [&](const Json& one) { return is_number_of(one, range); });
  if (value != nullptr) return value->get<double>();
  return range.open || range.low == -kLargestNumber ? std::clamp(1.0, range.low, range.high) : range.low;
}

std::optional<std::size_t> JsonFields::choice(const JsonNode& node, const std::vector<std::string>& names) {
  if (node.value == nullptr) return std::nullopt;
  const auto name = std::find(names.begin(), names.end(), *node.value);
  if (name != names.end()) return static_cast<std::size_t>(name - names.begin());
  complain(node.pointer, found(*node.value) + ", expected one of " + joined(names));
  return std::nullopt;
}

void JsonFields::refuse_unknown(const JsonNode& top) {
  for (const auto& [pointer, keys] : requested_) {
    const Json& object = pointer.empty() ? *top.value : top.value->at(Json::json_pointer(pointer));
    for (const auto& one : object.items()) {
      if (std::find(keys.begin(), keys.end(), one.key()) != keys.end()) continue;
      complain(pointer + "/" + one.key(), "found an unknown field, expected one of " + joined(keys));
    }
  }
}

JsonNode JsonFields::list(const JsonNode& object, const char* key, const std::string& expected) {
  return {value_where(object, key, expected, &Json::is_array), object.pointer + "/" + key};
}

bool JsonFields::fill(const JsonNode& node, std::size_t expected_count, const std::string& words, double* values,
                      const NumberRange& range) {
  if (node.value == nullptr) return false;
  if (!node.value->is_array() || node.value->size() != expected_count) {
    complain(node.pointer, found(*node.value) + ", expected " + std::to_string(expected_count) + " " + words);
    return false;
  }
  for (std::size_t i = 0; i < expected_count; ++i) {
    const Json& entry = (*node.value)[i];
    if (!is_number_of(entry, range)) {
      complain(node.pointer + "/" + std::to_string(i), found(entry) + ", expected " + range.words());
      return false;
    }
    values[i] = entry.get<double>();
  }
  return true;
}

}  // namespace palpate
