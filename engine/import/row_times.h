// The times of the rows of a foreign table: those of a clock, or numbers with a unit.
// Thread guarantee: value type, slow side.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/import/table_number.h"

namespace palpate {

class RowTimes {
 public:
  explicit RowTimes(char decimal) : decimal_(decimal) {}

  // Determines from the fields of the first rows whether the times are those of a clock. Returns the median of the
  // steps, as in the file; 0 without any.
  double examine(const std::vector<std::string_view>& fields);
  bool are_of_a_clock() const noexcept { return clock_; }
  bool have_dates() const noexcept { return has_date_; }

  bool parse(std::string_view field, TableTime& time) const;

  // The time since that of the first call, in the unit of the file (a clock: s). A clock without dates that goes back
  // by more than half a day has passed midnight.
  double since_first(const TableTime& time) noexcept;
  int midnights() const noexcept { return midnights_; }
  // The time of the first call itself.
  double first() const noexcept { return static_cast<double>(first_.whole) + first_.fraction; }

 private:
  char decimal_;
  bool clock_ = false;
  bool has_date_ = false;
  bool started_ = false;
  TableTime first_;
  double last_ = 0.0;
  int midnights_ = 0;
};

}  // namespace palpate
