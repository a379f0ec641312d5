// palpate import: converts a table of another program to a recording.
#include <charconv>
#include <iostream>
#include <optional>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/import/import_table.h"
#include "models/samples/samples.h"
#include "scenes/cli/verbs.h"
#include "scenes/evaluation/evaluate.h"

namespace palpate::cli {
namespace {

struct ImportOptions {
  std::string file, out;
  std::vector<std::string> columns, units, flips;
  std::string decimal;
  ImportRequest request;  // its rate, gain and number of bad rows
  std::string origin, begin_as, tare, rows;
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

// "12-340"
std::optional<LineRange> line_range(const std::string& text) {
  LineRange range;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '-') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.last);
  const bool whole = last.ec == std::errc() && last.ptr == end;
  return whole && range.first > 0 && range.first <= range.last ? std::optional(range) : std::nullopt;
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
  if (!options.rows.empty()) request.rows = line_range(options.rows);
  request.command = command_line();
  return request;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  return parse_number(text.data(), end, value) == end ? std::optional(value) : std::nullopt;
}

// Applies --tare and then --begin-as or --zero: "auto", "contact", "first" or a value. Adds a note for each.
Status move_zeros(const ImportOptions& options, ImportedTable& table) {
  Recording& recording = table.recording;
  if (!options.tare.empty()) {
    double zero_N = finite_number(options.tare).value_or(0.0);
    if (options.tare == "auto") {
      const auto air_N = free_air_force_N(*prepare_recording(recording));
      if (!air_N)
        return Error{"the force of free air cannot be identified, because there is no free air; give --tare VALUE_N"};
      zero_N = *air_N;
    }
    for (RecordingRow& row : recording.rows) row.force_N -= zero_N;
    table.notes.push_back("force 0 was at " + fixed(zero_N, 4) + " N in the table");
  }
  if (options.origin.empty() && options.begin_as.empty()) return {};
  const RecordingRow first = recording.rows.front();
  double at_m = first.position_m;
  if (!options.begin_as.empty()) {
    const auto other = read_recording(options.begin_as);
    if (!other) return Error{"--begin-as: " + other.error().message};
    const RecordingRow& begin = other->rows.front();
    if (!same_preload(first.force_N, begin.force_N, JndLine{}))
      return Error{"found " + general(first.force_N, 3) + " N in the first row and " + general(begin.force_N, 3) +
                   " N in that of " + options.begin_as +
                   ", expected the same preload of more than 0.2 N; give --zero a position in metres"};
    at_m -= begin.position_m;
  } else if (options.origin == "contact") {
    const SurfaceEstimate surface = prepare_recording(recording)->surface;
    if (!surface.identified()) {
      return Error{std::string("the position where the force begins cannot be identified") +
                   (surface.air.found ? "" : ", because there is no free air") +
                   "; give --zero first or a position in metres"};
    }
    at_m = surface.raw_offset_m;
  } else if (options.origin != "first") {
    at_m = finite_number(options.origin).value_or(0.0);  // checked by is_zero
  }
  for (RecordingRow& row : recording.rows) row.position_m -= at_m;
  table.notes.push_back("position 0 was at " + fixed(1e3 * at_m, 4) + " mm in the table" +
                        (options.begin_as.empty() ? "" : ": the recording begins where " + options.begin_as + " does"));
  return {};
}

// Checks that `good` holds for the text of an option.
CLI::Validator expecting(const std::string& expected, bool (*good)(const std::string&), const std::string& type = "") {
  return {[=](const std::string& text) { return good(text) ? "" : "found \"" + text + "\", expected " + expected; },
          type};
}

bool is_zero(const std::string& text) { return text == "contact" || text == "first" || finite_number(text); }
bool is_tare(const std::string& text) { return text == "auto" || finite_number(text); }
bool is_gain(const std::string& text) { return finite_number(text).value_or(0.0) != 0.0; }
bool is_range(const std::string& text) { return line_range(text).has_value(); }

double seconds_of(const ImportedTable& table) {
  return table.recording.rows.back().time_s - table.recording.rows.front().time_s;
}

void print_text(const ImportOptions& options, const ImportRequest& request, const ImportedTable& table) {
  std::cout << "table      " << layout_words(table) << "\n";
  for (const std::string& rows : row_words(table)) std::cout << "rows       " << rows << "\n";
  for (std::size_t role = 0; role < kRoles; ++role) {
    const std::string name = kRoleNames[role];
    std::cout << name << std::string(11 - name.size(), ' ') << column_words(table.columns[role]) << "\n";
  }
  for (const std::string& flip : flipped_roles(request)) std::cout << "flipped    " << flip << "\n";
  for (const std::string& note : table.notes) std::cout << "note       " << note << "\n";
  std::cout << "written    " << printable(options.out, std::string::npos) << ": " << table.recording.rows.size()
            << " rows, " << seconds_of(table) << " s\nnext       " << with_program_name("palpate check ")
            << shell_word(options.out) << "\n";
}

void print_import_json(const ImportOptions& options, const ImportRequest& request, const ImportedTable& table) {
  using Json = nlohmann::ordered_json;
  const double seconds = seconds_of(table);
  const double rate_Hz = request.rate_Hz.value_or(static_cast<double>(table.recording.rows.size() - 1) / seconds);
  Json left_out = Json::array();
  for (const LeftOut& one : table.left_out)
    left_out.push_back(
        {{"reason", one.reason}, {"rows", one.rows}, {"first_line", one.lines.first}, {"last_line", one.lines.last}});
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
              {"first_line", table.lines.first},
              {"last_line", table.lines.last},
              {"left_out", left_out},
              {"seconds", seconds},
              {"rate_Hz", static_cast<double>(table.recording.rows.size() - 1) / seconds},
              {"encoding", table.encoding},
              {"delimiter", table.delimiter},
              {"decimal", table.decimal},
              {"header_line", table.header_line},
              {"columns", columns},
              {"flips", flipped_roles(request)},
              {"notes", table.notes}});
}

Status run_import(const ImportOptions& options) {
  std::vector<std::string> inputs = {options.file};
  if (!options.begin_as.empty()) inputs.push_back(options.begin_as);
  if (const Status status = refuse_input_as_output(options.out, inputs, "--out"); !status) return status;
  const ImportRequest request = import_request(options);
  // Reports before the import if the output cannot be written.
  if (const auto trial = AtomicFile::create(options.out, options.force); !trial) return trial.error();
  auto table = import_table(options.file, request);
  if (!table) return table.error();
  if (const Status moved = move_zeros(options, *table); !moved)
    return Error{options.file + ": " + moved.error().message};
  if (const Status fits = check_limits(options.file, request, *table); !fits) return fits;
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
  CLI::Option* zero =
      verb->add_option(
              "--zero,--origin", options->origin,
              "Position that becomes 0: contact (where the force begins), first (the first row), or a value in m "
              "[unchanged]")
          ->check(expecting("contact, first or metres", is_zero, "contact|first|M"));
  verb->add_option("--begin-as", options->begin_as,
                   "Training recording under the same preload: the positions are moved so that both begin at one "
                   "position, which uses the first force of this recording [unchanged]")
      ->excludes(zero)
      ->type_name("REC.csv");
  verb->add_option("--tare", options->tare,
                   "Force that becomes 0: auto (the force of free air), or a value in N [unchanged]")
      ->check(expecting("auto or newtons", is_tare, "auto|N"));
  verb->add_option("--rows", options->rows, "Lines of the file, from 1, that hold the rows [all]")
      ->check(expecting("two lines of the file, as in 12-340", is_range))
      ->type_name("FROM-TO");
  verb->add_option("--block", options->request.block, "Block of rows to read, from 1, where there are several")
      ->check(number_from(1.0, 1e9))
      ->type_name("N");
  verb->add_option("--gain", options->request.gain_N_per_V, "Newtons per volt, for a force recorded in volts")
      ->check(expecting("newtons per volt, a number other than 0", is_gain))
      ->type_name("N_PER_V");
  verb->add_option("--skip-bad-rows", options->request.skip_bad_rows,
                   "Largest number of unreadable rows to leave out; the others keep their times [0]")
      ->check(number_from(0.0, 1e9))
      ->type_name("N");
  verb->add_option("--decimal", options->decimal, "Decimal mark: point or comma [guessed]")
      ->check(CLI::IsMember({"point", "comma"}));
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->add_flag("--force", options->force, "Replace an existing file");
  for (CLI::Option* option : verb->get_options())
    if (option->get_items_expected_max() == 1) option->take_last();  // a ready command may repeat an option
  verbs.emplace_back(verb, [options] { return run_import(*options); });
}

}  // namespace palpate::cli
