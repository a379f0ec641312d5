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
  ColumnFinder(std::string_view text, const ImportRequest& request, TableLayout& layout, ImportMessages& messages)
      : text_(text), request_(request), layout_(layout), messages_(messages) {}

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
      return messages_.fail_at(upper,
                               "found names of columns in this line and in line " + std::to_string(lower) +
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
      messages_.note("warning: the header in line " + std::to_string(layout_.header_line) + " is not used: it has " +
                     found);
      layout_.names.clear();
      layout_.header_line = 0;
      return {};
    }
    std::vector<std::string> known(units.begin(), units.end());
    std::erase(known, "");
    return messages_.fail_at(
        layout_.header_line,
        "found a header of " + found + ", expected a name for each field; correct the header, " + advice +
            (known.empty() ? "" : ", with the units of the header: --units " + joined(known, ",")));
  }

  // The unit of a role: that of the user, otherwise that of the header. For the times those of a clock come first, and
  // the only unit with a valid rate last; for the force a gain.
  Status find_unit_of(std::size_t role) {
    constexpr const char* kQuantities[] = {"time", "length", "force"};
    const auto quantity = static_cast<Quantity>(role);
    const std::size_t index = found_.index_of(role);
    const NameAndUnit& parts = found_.header[index].parts;
    const std::string header = " \"" + printable(found_.header[index].header) + "\"";
    const std::string in_header = parts.unit ? std::string(parts.unit->name) : printable(parts.foreign_unit);
    const double step = role == 0 ? examine_times() : 0.0;
    if (role == 0 && found_.times.are_of_a_clock()) return use_unit(role, {"clock", quantity, 1.0});
    std::optional<Unit> unit = parts.unit;
    for (const Unit& given : request_.units)
      if (given.quantity == quantity) unit = given;
    const bool fits = unit && unit->quantity == quantity;
    const double volts = role == 2 ? volts_of(parts.foreign_unit) : 0.0;
    if (role == 2 && request_.gain_N_per_V && (fits || !unit)) {
      if (parts.unit)
        messages_.note("warning: the force" + found_.quoted_name(index) +
                       " is read in V as --gain says, although its header says " + in_header);
      return use_unit(role, {"V", quantity, (volts > 0.0 ? volts : 1.0) * *request_.gain_N_per_V});
    }
    if (volts > 0.0) {
      return messages_.fail("found volts in the column" + header +
                            ", expected a force; say how many newtons a volt is: --gain N_PER_V");
    }
    if (fits) {
      // A note where the unit of the user contradicts that of the header.
      if (parts.unit ? parts.unit->to_si != unit->to_si : !in_header.empty()) {
        messages_.note("warning: the " + std::string(kRoleNames[role]) + found_.quoted_name(index) + " is read in " +
                       std::string(unit->name) + " as --units says, although its header says " + in_header);
      }
      return use_unit(role, *unit);
    }
    if (!parts.foreign_unit.empty() || (unit && role > 0)) {
      return messages_.fail_at(layout_.header_line,
                               "found the unit \"" + in_header + "\" in column " + std::to_string(index + 1) + header +
                                   ", expected a unit of " + kQuantities[role] + " (" + unit_names(quantity) +
                                   "); convert the column to one of these, choose another column with --columns " +
                                   kRoleNames[role] +
                                   "=NAME, or give the unit of the numbers with --units if the header is wrong");
    }
    if (role == 0) return guess_time_unit(step);
    return messages_.fail("found no known unit of the " + std::string(kRoleNames[role]) + found_.quoted_name(index) +
                          ", expected one of " + unit_names(quantity) + "; add the unit of the numbers with --units " +
                          (role == 1 ? "mm" : "N") + ", with a comma between two units: --units mm,N");
  }

  // Returns the step of the times in the file.
  double examine_times() {
    const std::size_t index = found_.index_of(0);
    std::vector<std::string_view> fields;
    for (const auto& row : first_rows_) fields.push_back(index < row.size() ? row[index] : std::string_view());
    found_.times = RowTimes(layout_.decimal);
    return found_.times.examine(fields);
  }

  Status guess_time_unit(double step) {
    std::vector<std::string> possible;
    for (const char* unit : {"s", "ms", "us", "ns"})
      if (step > 0.0 && rate_in_range(step * find_unit(unit)->to_si)) possible.emplace_back(unit);
    if (possible.size() != 1) {
      return messages_.fail("found no unit of the time" + found_.quoted_name(found_.index_of(0)) + " and steps of " +
                            general(step, 6) + "; add --units " +
                            (possible.empty() ? "s, ms, us or ns" : joined(possible, " or --units ")) +
                            ", or --rate HZ if the rows are evenly spaced");
    }
    messages_.note("the header has no unit of time: taken as " + possible.front() +
                   ", the only unit in which steps of " + general(step, 6) + " are a rate of 10 Hz to 20 kHz");
    return use_unit(0, *find_unit(possible.front()));
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
    if (!choice) return messages_.fail(choice.error().message);
    found_.roles = std::move(*choice);
    found_.velocity = find_velocity(found_.header);
    return {};
  }

  Result<TableColumns> run() {
    if (const Status status = check_header(); !status) return status.error();
    if (const Status status = choose(); !status) return status.error();
    if (found_.roles[0].number > 0) {
      const std::size_t notes = messages_.notes.size();
      const Status status = find_unit_of(0);
      found_.own_time = status.ok();
      if (!status && !request_.rate_Hz) return status.error();
      if (request_.rate_Hz) messages_.notes.resize(notes);
    }
    for (const std::size_t role : {1u, 2u})
      if (const Status status = find_unit_of(role); !status) return status.error();
    return std::move(found_);
  }

 private:
  Status use_unit(std::size_t role, const Unit& unit) {
    found_.to_si[role] = unit.to_si;
    found_.roles[role].unit = unit.name;
    return {};
  }

  std::string_view text_;
  const ImportRequest& request_;
  TableLayout& layout_;
  ImportMessages& messages_;
  std::vector<std::vector<std::string_view>> first_rows_;  // their fields
  TableColumns found_;
};

}  // namespace

std::string TableColumns::quoted_name(std::size_t index) const {
  // Without a header the names are values of the first row, and the roles have no names.
  const bool named = std::ranges::any_of(roles, [](const ImportedColumn& role) { return !role.header.empty(); });
  return named ? " \"" + printable(header[index].header) + "\"" : "";
}

Result<TableColumns> find_table_columns(std::string_view text, const ImportRequest& request, TableLayout& layout,
                                        ImportMessages& messages) {
  return ColumnFinder(text, request, layout, messages).run();
}

}  // namespace palpate
