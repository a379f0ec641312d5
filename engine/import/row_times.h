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
  void use_unit(double to_si) noexcept { to_si_ = to_si; }

  bool parse(std::string_view field, TableTime& time) const;

  enum class Step { later, after_midnight, repeated, backward };
  // Adds the time of the next row. A repeated or earlier time is not added. A clock without dates that goes back by
  // more than half a day has passed midnight.
  Step add(const TableTime& time) noexcept;
  // Since the first time, s.
  double seconds(const TableTime& time) const noexcept;
  double last_s() const noexcept { return last_s_; }
  // The first time itself, s.
  double first_s() const noexcept { return to_si_ * (static_cast<double>(first_.whole) + first_.fraction); }

 private:
  char decimal_;
  bool clock_ = false;
  bool has_date_ = false;
  double to_si_ = 1.0;
  bool started_ = false;
  TableTime first_;
  double last_s_ = 0.0;
  std::int64_t midnights_ = 0;
};

}  // namespace palpate
