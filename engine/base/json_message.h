// What the readers of small JSON files (scenes, calibrations, JND lines) say of what
// they find. Templates on the JSON document's type: engine knows no JSON library.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <exception>
#include <string>
#include <string_view>

#include "engine/base/json_position.h"
#include "engine/base/result.h"

namespace palpate {

// "found " and what stands there, short enough for a message.
template <typename Json>
std::string found(const Json& value) {
  constexpr std::size_t kMost = 40;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kMost) text = text.substr(0, kMost - 3) + "...";
  return "found " + text;
}

// The numbers that a field may hold, both ends included unless `open`: then not `low`.
struct NumberRange {
  double low = 0.0;
  double high = 1.0;
  bool open = false;

  bool holds(double number) const noexcept { return (open ? number > low : number >= low) && number <= high; }
  // "a number above 0 up to 100"
  std::string words() const;
};

// The document in `text`. Errors: path:line:column and what is no JSON there.
template <typename Json>
Result<Json> parse_json_document(std::string_view text, const std::string& path) {
  try {
    return Json::parse(text);
  } catch (const typename Json::parse_error& error) {
    const std::size_t offset = error.byte > 0 ? error.byte - 1 : 0;
    // The library's own words, without its number and its idea of the place.
    std::string what = error.what();
    if (const std::size_t detail = what.find("syntax error"); detail != std::string::npos) what = what.substr(detail);
    return Error{position_prefix(path, position_of_offset(text, offset)) + what};
  } catch (const std::exception& error) {
    return Error{path + ": " + error.what()};
  }
}

}  // namespace palpate
