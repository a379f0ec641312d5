// The bytes of a file that another program wrote, as text that can be searched, from
// UTF-8 (with or without a byte order mark), Latin-1 and UTF-16 with one, either way round.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

enum class TextEncoding { utf8, latin1, utf16 };
std::string_view encoding_name(TextEncoding encoding);

struct ForeignText {
  std::string text;  // as UTF-8, without a mark
  TextEncoding encoding = TextEncoding::utf8;
};

// Errors: no such file, not a plain file, unreadable, empty, an Excel workbook or another
// binary file; each says what to do.
Result<ForeignText> read_foreign_text(const std::string& path);
// The same from memory; `label` stands in messages.
Result<ForeignText> decode_foreign_text(std::string bytes, const std::string& label);

}  // namespace palpate
