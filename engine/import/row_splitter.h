// The three fields of a row that are wanted, without looking at the others: what
// every row of an import goes through.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "engine/import/column_roles.h"
#include "engine/import/table_layout.h"

namespace palpate {

// Fields of one row that are wanted, in the order of the file; fast, without quotes.
class RowSplitter {
 public:
  explicit RowSplitter(Delimiter delimiter) : delimiter_(delimiter) {}

  // How many fields; `wanted[i]` becomes field `index[i]`, empty when it is missing.
  void split(std::string_view line, const std::array<std::size_t, kRoles>& index,
             std::array<std::string_view, kRoles>& wanted) {
    wanted = {};
    const bool simple = delimiter_ != Delimiter::blanks && line.find('"') == std::string_view::npos;
    if (!simple) {
      split_table_fields(line, delimiter_, fields_);
      for (std::size_t i = 0; i < kRoles; ++i) {
        if (index[i] < fields_.size()) wanted[i] = fields_[index[i]];
      }
      return;
    }
    constexpr char kMarks[] = {',', ';', '\t'};
    const char mark = kMarks[static_cast<std::size_t>(delimiter_)];
    const std::size_t last = *std::max_element(index.begin(), index.end(), [](std::size_t a, std::size_t b) {
      return (a == kNoColumn ? 0 : a + 1) < (b == kNoColumn ? 0 : b + 1);
    });
    for (std::size_t column = 0, begin = 0; column <= last; ++column) {
      const std::size_t end = std::min(line.find(mark, begin), line.size());
      for (std::size_t i = 0; i < kRoles; ++i) {
        if (index[i] == column) wanted[i] = line.substr(begin, end - begin);
      }
      if (end == line.size()) return;
      begin = end + 1;
    }
  }

  static constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

 private:
  Delimiter delimiter_;
  std::vector<std::string_view> fields_;
};

}  // namespace palpate
