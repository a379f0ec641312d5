// Where in a JSON text a value stands, for messages that name line and column.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate {

// Line and column from 1; columns count bytes.
struct TextPosition {
  std::size_t line = 1;
  std::size_t column = 1;
};

// "path:line:column: ", as messages begin.
std::string position_prefix(const std::string& path, TextPosition position);

// Of the byte at `offset`, clamped to the end of the text.
TextPosition position_of_offset(std::string_view text, std::size_t offset);

// Of the value at a JSON pointer such as "/features/2/kind" ("" is the whole
// document). `text` is valid JSON. A value that is missing has the position of
// the deepest value on the way to it. Keys with escapes, '/' or '~' are not
// found.
TextPosition position_of_value(std::string_view text, std::string_view pointer);

}  // namespace palpate
