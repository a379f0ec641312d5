// palpate import: converts a table of another program to a recording.
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "engine/import/import_table.h"
#include "models/samples/samples.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

struct ImportOptions {
  std::string file, out;
  std::vector<std::string> columns, units, flips;
  std::string decimal;
  ImportRequest request;  // its rate, gain and number of bad rows
  std::string origin;
  bool json = false, force = false;
};

// Assigns the column of an argument such as "time=NAME" to its role.
void read_column(const std::string& text, RoleRequest& columns) {
  const std::size_t equals = text.find('=');
  for (std::size_t role = 0; role < kRoles && equals != std::string::npos; ++role) {
    if (text.substr(0, equals) != kRoleNames[role] || equals + 1 == text.size()) continue;
    columns[role] = text.substr(equals + 1);
    return;
  }
  throw CLI::ValidationError("--columns", "found \"" + text + "\", expected time=NAME, position=NAME or force=NAME");
}

void read_unit(const std::string& text, std::vector<Unit>& units) {
  const auto unit = find_unit(text);
  if (!unit) {
    throw CLI::ValidationError(
        "--units", "found \"" + text + "\", expected a unit of length (" + unit_names(Quantity::length) + "), force (" +
                       unit_names(Quantity::force) + ") or time (" + unit_names(Quantity::time) + ")");
  }
  for (const Unit& other : units) {
    if (other.quantity == unit->quantity) {
      throw CLI::ValidationError("--units", "found " + std::string(other.name) + " and " + std::string(unit->name) +
                                                ", expected at most one unit of length, of force and of time");
    }
  }
  units.push_back(*unit);
}

ImportRequest import_request(const ImportOptions& options) {
  ImportRequest request = options.request;
  for (const std::string& column : options.columns) read_column(column, request.columns);
  for (const std::string& unit : options.units) read_unit(unit, request.units);
  for (const std::string& flip : options.flips) {
    request.flip_position = request.flip_position || flip != "force";
    request.flip_force = request.flip_force || flip != "position";
  }
  if (!options.decimal.empty()) request.decimal = options.decimal == "comma" ? ',' : '.';
  return request;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  return parse_number(text.data(), end, value) == end ? std::optional(value) : std::nullopt;
}

// Applies --zero: "contact", "first" or a position in metres.
Status move_origin(const std::string& origin, Recording& recording) {
  double at_m = recording.rows.front().position_m;
  if (origin == "contact") {
    const SurfaceEstimate surface = prepare_recording(recording)->surface;
    if (!surface.identified()) {
      return Error{std::string("the position where the force begins cannot be identified") +
                   (surface.air.found ? "" : ", because there is no free air") +
                   "; give --zero first or a position in metres"};
    }
    at_m = surface.raw_offset_m;
  } else if (origin != "first") {
    at_m = finite_number(origin).value_or(0.0);  // checked by check_origin
  }
  for (RecordingRow& row : recording.rows) row.position_m -= at_m;
  return {};
}

std::string check_origin(const std::string& origin) {
  return origin == "contact" || origin == "first" || finite_number(origin)
             ? ""
             : "found \"" + origin + "\", expected contact, first or metres";
}

std::string check_gain(const std::string& gain) {
  return finite_number(gain).value_or(0.0) != 0.0
             ? ""
             : "found \"" + gain + "\", expected newtons per volt, a number other than 0";
}

double seconds_of(const ImportedTable& table) {
  return table.recording.rows.back().time_s - table.recording.rows.front().time_s;
}

void print_text(const ImportOptions& options, const ImportRequest& request, const ImportedTable& table) {
  std::cout << "table      " << table.layout.words(table.encoding) << "\n";
  for (std::size_t role = 0; role < kRoles; ++role) {
    const std::string name = kRoleNames[role];
    std::cout << name << std::string(11 - name.size(), ' ') << column_words(table.columns[role]) << "\n";
  }
  for (const std::string& flip : flipped_roles(request)) std::cout << "flipped    " << flip << "\n";
  for (const std::string& note : table.notes) std::cout << "note       " << note << "\n";
  std::cout << "written    " << printable(options.out, std::string::npos) << ": " << table.recording.rows.size()
            << " rows, " << seconds_of(table) << " s\nnext       palpate check " << shell_word(options.out) << "\n";
}

void print_import_json(const ImportOptions& options, const ImportRequest& request, const ImportedTable& table) {
  using Json = nlohmann::ordered_json;
  const double seconds = seconds_of(table);
  const double rate_Hz = request.rate_Hz.value_or(static_cast<double>(table.recording.rows.size() - 1) / seconds);
  Json columns = Json::object();
  for (std::size_t role = 0; role < kRoles; ++role) {
    const ImportedColumn& column = table.columns[role];
    if (column.number == 0) {
      columns[kRoleNames[role]] = {{"rate_Hz", rate_Hz}};
    } else {
      columns[kRoleNames[role]] = {
          {"number", column.number}, {"name", column.header}, {"unit", column.unit}, {"guessed", column.guessed}};
    }
  }
  print_json({{"file", options.file},
              {"out", options.out},
              {"rows", table.recording.rows.size()},
              {"seconds", seconds},
              {"rate_Hz", static_cast<double>(table.recording.rows.size() - 1) / seconds},
              {"encoding", table.encoding},
              {"delimiter", table.layout.delimiter.name},
              {"decimal", table.layout.decimal_name()},
              {"header_line", table.layout.header_line},
              {"data_line", table.layout.data_line},
              {"columns", columns},
              {"flips", flipped_roles(request)},
              {"notes", table.notes}});
}

Status run_import(const ImportOptions& options) {
  if (const Status status = refuse_input_as_output(options.out, {options.file}, "--out"); !status) return status;
  const ImportRequest request = import_request(options);
  // Reports before the import if the output cannot be written.
  if (const auto trial = AtomicFile::create(options.out, options.force); !trial) return trial.error();
  auto table = import_table(options.file, request);
  if (!table) return table.error();
  if (!options.origin.empty()) {
    const double before_m = table->recording.rows.front().position_m;
    if (Status status = move_origin(options.origin, table->recording); !status)
      return Error{options.file + ": " + status.error().message};
    table->notes.push_back("position 0 was at " +
                           fixed(1e3 * (before_m - table->recording.rows.front().position_m), 4) + " mm in the table");
  }
  const Status written =
      write_recording(options.out, table->recording, import_origin(options.file, request, *table), options.force);
  if (!written) return written;
  if (options.json) {
    print_import_json(options, request, *table);
  } else {
    print_text(options, request, *table);
  }
  return {};
}

}  // namespace

void add_import(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* verb = app.add_subcommand("import", "Convert a table of another program to a recording");
  verb->add_option("file", options->file, "Table as text (CSV, TXT, LVM, TSV)")->required()->type_name("FILE");
  verb->add_option("--out", options->out, "Recording to write (CSV)")->required()->type_name("REC.csv");
  verb->add_option("--columns", options->columns, "Columns, by name or by number from 1 [guessed from the header]")
      ->delimiter(',')
      ->type_name("ROLE=NAME,...");
  verb->add_option("--units", options->units,
                   "Units that the header lacks or has wrong, such as mm,N or ms,mm,mN [from the header]")
      ->delimiter(',')
      ->type_name("UNIT,...");
  verb->add_option("--rate", options->request.rate_Hz,
                   "Rate of evenly spaced rows in Hz; the times in the file are ignored")
      ->check(number_from(10.0, 20000.0))
      ->type_name("HZ");
  verb->add_option("--flip", options->flips, "Reverse the sign of position, force or both")
      ->delimiter(',')
      ->check(CLI::IsMember({"position", "force", "both"}));
  verb->add_option("--zero,--origin", options->origin,
                   "Position that becomes 0: contact (where the force begins), first (the first row), or a value in m "
                   "[unchanged]")
      ->check(CLI::Validator(check_origin, "contact|first|M"));
  verb->add_option("--gain", options->request.gain_N_per_V, "Newtons per volt, for a force recorded in volts")
      ->check(CLI::Validator(check_gain, ""))
      ->type_name("N_PER_V");
  verb->add_option("--skip-bad-rows", options->request.skip_bad_rows,
                   "Largest number of unreadable rows to leave out [0]")
      ->check(number_from(0.0, 1e9))
      ->type_name("N");
  verb->add_option("--decimal", options->decimal, "Decimal mark: point or comma [guessed]")
      ->check(CLI::IsMember({"point", "comma"}));
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->add_flag("--force", options->force, "Replace an existing file");
  verbs.emplace_back(verb, [options] { return run_import(*options); });
}

}  // namespace palpate::cli
