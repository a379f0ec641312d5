// Reads a file of another program as text: UTF-8 (with or without byte order mark), Latin-1, and UTF-16 with a byte
// order mark, of either byte order.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

// The largest table, which is read as a whole: six million rows, as many as are checked and fitted, of 89 bytes.
inline constexpr std::size_t kLargestTableBytes = std::size_t{512} << 20;

struct ForeignText {
  std::string text;                     // UTF-8 without byte order mark
  std::string_view encoding = "UTF-8";  // of the file: UTF-8, Latin-1 or UTF-16
};

// Errors: no such file, not a regular file, unreadable, too large, empty, an Excel workbook or another binary file;
// each with advice.
Result<ForeignText> read_foreign_text(const std::string& path);

}  // namespace palpate
