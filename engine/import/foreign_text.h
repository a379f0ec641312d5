// The bytes of a file that another program wrote, as text that can be searched:
// UTF-8 (with or without a byte order mark), Latin-1 and UTF-16 either way round.
//
// Only names of columns can hold anything beyond ASCII, so Latin-1 is converted there.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

enum class TextEncoding { utf8, latin1, utf16 };
std::string_view encoding_name(TextEncoding encoding);

class ForeignText {
 public:
  // Errors: no such file, not a plain file, unreadable, empty, an Excel workbook or
  // another binary file; each says what to do.
  static Result<ForeignText> open(const std::string& path);
  // The same from memory; `label` stands in messages.
  static Result<ForeignText> from_memory(std::string bytes, const std::string& label);

  std::string_view text() const { return text_; }
  TextEncoding encoding() const { return encoding_; }
  // A piece of `text` as UTF-8, for names and messages.
  std::string to_utf8(std::string_view piece) const;

 private:
  Status interpret(std::string_view bytes, const std::string& label);

  std::shared_ptr<const std::string> storage_;  // behind text_
  std::string_view text_;
  TextEncoding encoding_ = TextEncoding::utf8;
};

}  // namespace palpate
