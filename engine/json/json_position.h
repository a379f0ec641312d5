// Positions in JSON text, for messages.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

// Line and column from 1; columns count bytes.
struct TextPosition {
  std::size_t line = 1;
  std::size_t column = 1;
};

// "path:line:column: ", the beginning of a message.
std::string position_prefix(const std::string& path, TextPosition position);

// The position of the byte at `offset`, clamped to the end of the text.
TextPosition position_of_offset(std::string_view text, std::size_t offset);

// The position of the value at a JSON pointer such as "/features/2/kind" ("": the whole document) in valid JSON. A
// missing value has the position of the deepest existing value on its path. Keys with escapes, '/' or '~' are not
// found.
TextPosition position_of_value(std::string_view text, std::string_view pointer);

// The offset of the first bracket beyond the allowed nesting, if any. The text need not be valid.
std::optional<std::size_t> too_deep_at(std::string_view text, int nesting);
// The following are for valid text. The offset of the first name that is repeated in one object, if any.
std::optional<std::size_t> repeated_name_at(std::string_view text);
// The first number beyond the range of a double; empty if there is none. The text before it is valid.
std::string_view too_large_number(std::string_view text);

}  // namespace palpate
