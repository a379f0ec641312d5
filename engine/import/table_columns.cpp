#include "engine/import/table_columns.h"

#include <algorithm>
#include <utility>

#include "engine/base/text.h"
#include "engine/recording/recording.h"

namespace palpate {
namespace {

// The first rows determine which columns are constant, and the unit of time.
constexpr std::size_t kFirstRows = 200;

class ColumnFinder {
 public:
  ColumnFinder(std::string_view text, const std::string& label, const ImportRequest& request, TableLayout& layout,
               std::vector<std::string>& notes)
      : text_(text), label_(label), request_(request), layout_(layout), notes_(notes) {}

  // The unit of `quantity`: that of the user, otherwise that of the header.
  std::optional<Unit> unit_of(Quantity quantity, const ImportRequest& request, const ForeignColumn& column) {
    for (const Unit& unit : request.units)
      if (unit.quantity == quantity) return unit;
    return column.parts.unit;
  }

  // Refuses a header that does not determine the columns, unless the user gives their numbers.
  Status check_header() {
    if (!layout_.misfit && layout_.rival_line == 0) return {};
    const auto first_role = request_.rate_Hz ? 1 : 0;
    const bool decided = std::all_of(
        request_.columns.begin() + first_role, request_.columns.end(),
        [](const auto& name) { return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos; });
    const std::string advice = std::string("or say which column is which by their numbers: --columns ") +
                               (first_role == 0 ? "time=N," : "") + "position=N,force=N";
    if (!layout_.misfit) {
      if (decided) return {};
      const auto [upper, lower] = std::minmax(layout_.header_line, layout_.rival_line);
      return fail_at(upper, "found names of columns in this line and in line " + std::to_string(lower) +
                                " that put the position and the force into different columns, expected one header; "
                                "remove the wrong line, " +
                                advice);
    }
    std::vector<std::string> names;
    std::array<std::string, kRoles> units;
    for (const std::string_view name : layout_.names) {
      names.push_back('"' + printable(name) + '"');
      const auto unit = split_name_and_unit(name).unit;
      if (unit) units[static_cast<std::size_t>(unit->quantity)] = unit->name;
    }
    const std::string found = std::to_string(names.size()) + " names (" + joined(names) + "), but the rows from line " +
                              std::to_string(layout_.data_line) + " have " + std::to_string(layout_.columns) +
                              " fields";
    if (decided) {
      note("warning: the header in line " + std::to_string(layout_.header_line) + " is not used: it has " + found);
      layout_.names.clear();
      layout_.header_line = 0;
      return {};
    }
    std::vector<std::string> known(units.begin(), units.end());
    std::erase(known, "");
    return fail_at(layout_.header_line,
                   "found a header of " + found + ", expected a name for each field; correct the header, " + advice +
                       (known.empty() ? "" : ", with the units of the header: --units " + joined(known, ",")));
  }

  // The error of a column with an unknown unit.
  Error unknown_unit(std::size_t role) const {
    constexpr const char* kQuantities[] = {"time", "length", "force"};
    const ForeignColumn& column = found_.header[found_.index_of(role)];
    return fail_at(layout_.header_line,
                   "found the unit \"" + printable(column.parts.foreign_unit) + "\" in column " +
                       std::to_string(found_.index_of(role) + 1) + " \"" + printable(column.header) +
                       "\", expected a unit of " + kQuantities[role] + " (" + unit_names(static_cast<Quantity>(role)) +
                       "); convert the column to one of these, choose another column with --columns " +
                       kRoleNames[role] + "=NAME, or give the unit of the numbers with --units if the header is wrong");
  }

  // A note where a unit of the user contradicts that of the header.
  void compare_unit(std::size_t role, const Unit& used) {
    const NameAndUnit& parts = found_.header[found_.index_of(role)].parts;
    const bool same = parts.unit ? parts.unit->to_si == used.to_si : parts.foreign_unit.empty();
    if (same) return;
    note("warning: the " + std::string(kRoleNames[role]) + found_.quoted_name(found_.index_of(role)) + " is read in " +
         std::string(used.name) + " as --units says, although its header says " +
         (parts.unit ? std::string(parts.unit->name) : printable(parts.foreign_unit)));
  }

  // Finds the unit of position or force.
  Status find_unit_of(std::size_t role) {
    const Quantity quantity = static_cast<Quantity>(role);
    const auto& column = found_.header[found_.index_of(role)];
    const std::optional<Unit> unit = unit_of(quantity, request_, column);
    if (unit && unit->quantity != quantity) {
      return fail("found the unit " + std::string(unit->name) + " in the column \"" + printable(column.header) +
                  "\", expected one of a " + (role == 1 ? "length" : "force") + " for the " + kRoleNames[role] +
                  "; choose another with --columns " + kRoleNames[role] + "=NAME; the columns are " +
                  list_columns(found_.header));
    }
    const double volts = role == 2 ? volts_of(column.parts.foreign_unit) : 0.0;
    if (role == 2 && request_.gain_N_per_V) {
      use_unit(role, {"V", quantity, (volts > 0.0 ? volts : 1.0) * *request_.gain_N_per_V});
      return {};
    }
    if (volts > 0.0) {
      return fail("found volts in the column \"" + printable(column.header) +
                  "\", expected a force; say how many newtons a volt is: --gain N_PER_V");
    }
    if (!unit && !column.parts.foreign_unit.empty()) return unknown_unit(role);
    if (!unit) {
      return fail("found no known unit of the " + std::string(kRoleNames[role]) +
                  found_.quoted_name(found_.index_of(role)) + ", expected one of " + unit_names(quantity) +
                  "; add the unit of the numbers with --units " + (role == 1 ? "mm" : "N") +
                  ", with a comma between two units: --units mm,N");
    }
    compare_unit(role, *unit);
    use_unit(role, *unit);
    return {};
  }

  // The times are those of a clock, have a unit from the header or the user, or are in the only unit with a valid rate.
  Status find_time_unit() {
    const std::size_t index = found_.index_of(0);
    std::vector<std::string_view> fields;
    for (const auto& row : first_rows_) fields.push_back(index < row.size() ? row[index] : std::string_view());
    found_.times = RowTimes(layout_.decimal);
    const double step = found_.times.examine(fields);
    std::optional<Unit> unit = unit_of(Quantity::time, request_, found_.header[index]);
    if (found_.times.are_of_a_clock()) unit = Unit{"clock", Quantity::time, 1.0};
    if (unit && unit->quantity == Quantity::time) {
      if (!found_.times.are_of_a_clock()) compare_unit(0, *unit);
      use_unit(0, *unit);
      return {};
    }
    if (!found_.header[index].parts.foreign_unit.empty()) return unknown_unit(0);
    std::vector<Unit> possible;
    for (const char* name : {"s", "ms", "us", "ns"}) {
      const Unit candidate = *find_unit(name);
      if (step > 0.0 && rate_in_range(step * candidate.to_si)) possible.push_back(candidate);
    }
    if (possible.size() != 1) {
      const std::string choices = possible.empty()
                                      ? "s, ms, us or ns"
                                      : std::string(possible[0].name) + " or --units " + std::string(possible[1].name);
      return fail("found no unit of the time" + found_.quoted_name(index) + " and steps of " + general(step, 6) +
                  "; add --units " + choices + ", or --rate HZ if the rows are evenly spaced");
    }
    use_unit(0, possible.front());
    note("the header has no unit of time: taken as " + found_.roles[0].unit + ", the only unit in which steps of " +
         general(step, 6) + " are a rate of 10 Hz to 20 kHz");
    return {};
  }

  Status choose() {
    std::string_view rest = text_.substr(layout_.data_offset);
    while (first_rows_.size() < kFirstRows && !rest.empty())
      split_table_fields(next_line(rest), layout_.delimiter, first_rows_.emplace_back());
    found_.header = foreign_columns(layout_, first_rows_);
    const bool has_header = !layout_.names.empty();
    auto choice = choose_columns(found_.header, request_.columns, has_header, true);
    // With a given rate the times of the file are only compared with it.
    if (request_.rate_Hz && !choice) choice = choose_columns(found_.header, request_.columns, has_header, false);
    if (!choice) return fail(choice.error().message);
    found_.roles = std::move(*choice);
    found_.velocity = find_velocity(found_.header);
    return {};
  }

  Result<TableColumns> run() {
    if (const Status status = check_header(); !status) return status.error();
    if (const Status status = choose(); !status) return status.error();
    if (found_.roles[0].number > 0) {
      const std::size_t notes = notes_.size();
      const Status status = find_time_unit();
      found_.own_time = status.ok();
      if (!status && !request_.rate_Hz) return status.error();
      if (request_.rate_Hz) notes_.resize(notes);
    }
    for (const std::size_t role : {1u, 2u})
      if (const Status status = find_unit_of(role); !status) return status.error();
    return std::move(found_);
  }

 private:
  Error fail(const std::string& text) const { return Error{label_ + ": " + text}; }
  Error fail_at(std::uint64_t line, const std::string& text) const {
    return Error{label_ + ":" + std::to_string(line) + ": " + text};
  }
  void note(const std::string& sentence) { notes_.push_back(sentence); }
  void use_unit(std::size_t role, const Unit& unit) {
    found_.to_si[role] = unit.to_si;
    found_.roles[role].unit = unit.name;
  }

  std::string_view text_;
  const std::string& label_;
  const ImportRequest& request_;
  TableLayout& layout_;
  std::vector<std::string>& notes_;
  std::vector<std::vector<std::string_view>> first_rows_;  // their fields
  TableColumns found_;
};

}  // namespace

std::string TableColumns::quoted_name(std::size_t index) const {
  // Without a header the names are values of the first row, and the roles have no names.
  const bool named = std::ranges::any_of(roles, [](const ImportedColumn& role) { return !role.header.empty(); });
  return named ? " \"" + printable(header[index].header) + "\"" : "";
}

Result<TableColumns> find_table_columns(std::string_view text, const std::string& label, const ImportRequest& request,
                                        TableLayout& layout, std::vector<std::string>& notes) {
  return ColumnFinder(text, label, request, layout, notes).run();
}

}  // namespace palpate
