#include "tests/support/broken_recordings.h"

#include <string_view>

namespace palpate::test {
namespace {

using namespace std::string_literals;

const char* const kHeaderNames = "a header row with time_s, position_m and force_N";

// Three good rows (lines 2 to 4), then `row` in line 5, then ten more.
std::string with_row(const std::string& row) { return good_header() + good_rows(3) + row + "\n" + good_rows(10, 4); }

// Good rows with times `step` apart, written as an integer followed by `unit`.
std::string with_step(int rows, int step, const std::string& unit) {
  std::string text = good_header();
  for (int i = 0; i < rows; ++i) text += std::to_string(i * step) + unit + ",0.001,0.5\n";
  return text;
}

std::string all_lines(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

void add_headers(std::vector<BrokenRecording>& table) {
  const std::string rows = good_rows(12);
  const std::string no_header = "expected "s + kHeaderNames;
  table.insert(
      table.end(),
      {{"empty", "", "rec.csv:1:1: found an empty file, " + no_header + "; check that the recording was saved"},
       {"only a byte order mark", "\xEF\xBB\xBF",
        "rec.csv:1:1: found an empty file, " + no_header + "; check that the recording was saved"},
       {"only comments", "# one\n# two\n",
        "rec.csv:3:1: found the end of the file, " + no_header + "; check that the recording was saved"},
       {"blank first line", "\n"s + good_header() + rows,
        "rec.csv:1:1: found a blank line, " + no_header + "; remove the blank line"},
       {"no header", rows,
        "rec.csv:1:1: found a row of numbers, " + no_header +
            "; add the header row, or let palpate import rec.csv --out REC.csv do it"},
       {"missing column", "time_s,position_m\n0,0\n",
        "rec.csv:1:1: found columns time_s,position_m, expected also force_N; add the column or "
        "rename what holds the values, or let palpate import rec.csv --out REC.csv do it"},
       {"two missing columns", "# c\ntime_s,x,f\n0,0,0\n",
        "rec.csv:2:1: found columns time_s,x,f, expected also position_m and force_N; add the "
        "columns or rename what holds the values, or let palpate import rec.csv --out REC.csv do it"},
       {"unknown columns only", "a,b,c\n1,2,3\n",
        "rec.csv:1:1: found columns a,b,c, expected also time_s, position_m and force_N; add the "
        "columns or rename what holds the values, or let palpate import rec.csv --out REC.csv do it"},
       {"duplicate column", "time_s,position_m,force_N,position_m\n0,0,0,0\n",
        "rec.csv:1:27: found column position_m twice, expected it once; remove or rename one of "
        "the two"},
       {"duplicate optional column", "time_s,velocity_m_per_s,position_m,force_N,velocity_m_per_s\n",
        "rec.csv:1:44: found column velocity_m_per_s twice, expected it once; remove or rename one "
        "of the two"},
       {"quoted header", "\"time_s\",\"position_m\",\"force_N\"\n" + rows,
        "rec.csv:1:1: found column '\"time_s\"', expected exactly time_s; rename the column, or let palpate import "
        "rec.csv --out REC.csv do it"},
       {"blank before a name", "time_s, position_m,force_N\n" + rows,
        "rec.csv:1:9: found column ' position_m', expected exactly position_m; rename the column, or let palpate "
        "import rec.csv --out REC.csv do it"},
       {"other case", "time_s,position_m,Force_n\n" + rows,
        "rec.csv:1:19: found column 'Force_n', expected exactly force_N; rename the column, or let palpate import "
        "rec.csv --out REC.csv do it"},
       {"semicolons", "time_s;position_m;force_N\n0;0;0\n",
        "rec.csv:1:7: found semicolons between the fields, expected commas; save the file as comma "
        "separated with decimal points, or let palpate import rec.csv --out REC.csv do it"},
       {"tabs", "time_s\tposition_m\tforce_N\n0\t0\t0\n",
        "rec.csv:1:7: found tabs between the fields, expected commas; save the file as comma "
        "separated with decimal points, or let palpate import rec.csv --out REC.csv do it"},
       {"Latin-1 header",
        "time_s,position_m,force_N,Kr\xE4"
        "fte\n",
        "rec.csv:1:29: found byte \\xe4, expected UTF-8 text in the header; save the file as UTF-8 "
        "CSV"},
       {"overlong UTF-8", "time_s,position_m,force_N,\xC0\xAF\n",
        "rec.csv:1:27: found byte \\xc0, expected UTF-8 text in the header; save the file as UTF-8 "
        "CSV"},
       {"header only", good_header(), "rec.csv:2:1: found 0 rows, expected at least 10; record for longer"}});
}

void add_bytes(std::vector<BrokenRecording>& table) {
  const std::string nul =
      "found a NUL byte, expected UTF-8 text; this is a binary or UTF-16 file, save it as UTF-8 CSV";
  const std::string utf16 = "rec.csv:1:1: found UTF-16 text, expected UTF-8; save the file as UTF-8 CSV";
  const std::string carriage_return =
      "found a carriage return inside a line, expected lines that end in LF or CRLF; convert the "
      "line ends";
  const std::string long_line =
      "found a line longer than 65536 bytes, expected a row of a recording; check that this is a "
      "CSV file with line ends";
  table.insert(
      table.end(),
      {{"binary", "\x7F"s + "ELF\x02\x01\x01\0\0\0"s, "rec.csv:1:8: " + nul},
       {"NUL in a row", with_row("0.003,0.0\0,0.5"s), "rec.csv:5:10: " + nul},
       {"NUL in an ignored column", "time_s,note,position_m,force_N\n0,a\0b,0,0\n"s, "rec.csv:2:4: " + nul},
       {"UTF-16 little endian", "\xFF\xFEt\0i\0m\0e\0"s, utf16},
       {"UTF-16 big endian", "\xFE\xFF\0t\0i\0m\0e"s, utf16},
       {"UTF-16 without a mark", "t\0i\0m\0e\0"s, "rec.csv:1:2: " + nul},
       {"CR-only line ends", all_lines(good_recording(), "\n", "\r"), "rec.csv:1:26: " + carriage_return},
       {"CR-only line ends behind a comment", all_lines("# c\n" + good_recording(), "\n", "\r"),
        "rec.csv:1:4: " + carriage_return},
       {"CR-only rows", good_header() + all_lines(good_rows(12), "\n", "\r"), "rec.csv:2:16: " + carriage_return},
       {"gigantic header", std::string(70000, 'x'), "rec.csv:1:65537: " + long_line},
       {"gigantic comment", "#" + std::string(3000000, ' ') + "\n" + good_recording(), "rec.csv:1:65537: " + long_line},
       {"gigantic number", with_row("0.003,0.001," + std::string(65536, '1')), "rec.csv:5:65537: " + long_line},
       {"gigantic last line", good_header() + good_rows(12) + std::string(65537, '0'),
        "rec.csv:14:65537: " + long_line}});
}

void add_fields(std::vector<BrokenRecording>& table) {
  table.insert(table.end(),
               {{"short row", with_row("0.003,0.001"),
                 "rec.csv:5:12: found 2 fields, expected 3 as in the header; add the missing values or "
                 "remove the row"},
                {"one field", with_row("0.003"),
                 "rec.csv:5:6: found 1 field, expected 3 as in the header; add the missing values or remove "
                 "the row"},
                {"truncated last row", good_header() + good_rows(12) + "0.012,0.00",
                 "rec.csv:14:11: found 2 fields where the file ends, expected 3 as in the header; the file "
                 "was cut off, remove its last line"},
                {"truncated behind a comma", good_header() + good_rows(12) + "0.012,0.001,",
                 "rec.csv:14:13: found an empty field, expected a finite number in force_N; fill in the "
                 "value or remove the row"},
                {"too many fields", with_row("0.003,0.001,0.5,7"),
                 "rec.csv:5:17: found 4 fields, expected 3 as in the header; write decimal points, not "
                 "commas, and remove fields without a column"},
                {"locale commas", with_row("0,003,0,001,0,5"),
                 "rec.csv:5:9: found 6 fields, expected 3 as in the header; write decimal points, not "
                 "commas, and remove fields without a column"},
                {"trailing comma", with_row("0.003,0.001,0.5,"),
                 "rec.csv:5:17: found 4 fields, expected 3 as in the header; remove the comma at the end of "
                 "the row"},
                {"trailing comma in the header", "time_s,position_m,force_N,\n" + good_rows(12),
                 "rec.csv:2:16: found 3 fields, expected 4 as in the header; remove the comma at the end of "
                 "the header"},
                {"quoted locale comma", with_row("0.003,0.001,\"0,5\""),
                 "rec.csv:5:16: found 4 fields, expected 3 as in the header; remove quotes and the commas "
                 "inside them"},
                {"semicolons in rows", with_row("0.003;0.001;0.5"),
                 "rec.csv:5:6: found semicolons between the fields, expected commas; save the file as comma "
                 "separated with decimal points"},
                {"tabs in rows", with_row("0.003\t0.001\t0.5"),
                 "rec.csv:5:6: found tabs between the fields, expected commas; save the file as comma "
                 "separated with decimal points"},
                {"blank line in the middle", with_row(""),
                 "rec.csv:5:1: found a blank line, expected a row with 3 fields; remove the blank line"},
                {"line of blanks in the middle", with_row(" \t \n\n"),
                 "rec.csv:5:1: found a blank line, expected a row with 3 fields; remove the blank line"},
                {"comment behind the header", with_row("# pause"),
                 "rec.csv:5:1: found a comment after the header, expected a row; move it above the header "
                 "or remove it"},
                {"header again", with_row("time_s,position_m,force_N"),
                 "rec.csv:5:1: found \"time_s\", expected a finite number in time_s; remove the row or "
                 "repair the value"}});
}

// A recording with `field` as a force, and its message.
BrokenRecording bad_force(const char* name, const std::string& field, const std::string& found,
                          const std::string& advice, int column = 13) {
  return {
      name, with_row("0.003,0.001," + field),
      "rec.csv:5:" + std::to_string(column) + ": found " + found + ", expected a finite number in force_N; " + advice};
}

void add_numbers(std::vector<BrokenRecording>& table) {
  const std::string repair = "remove the row or repair the value";
  const std::string beyond = "it is beyond what a double can hold, repair the value";
  table.insert(table.end(),
               {bad_force("NaN", "nan", "\"nan\"", repair),
                bad_force("NaN in C", "-NaN", "\"-NaN\"", repair),
                bad_force("NaN of a compiler", "nan(0x1)", "\"nan(0x1)\"", repair),
                bad_force("infinity", "inf", "\"inf\"", repair),
                bad_force("minus infinity", "-Infinity", "\"-Infinity\"", repair),
                bad_force("huge number", "1e999", "\"1e999\"", beyond),
                bad_force("minus a huge number", "-1e400", "\"-1e400\"", beyond),
                bad_force("tiny number", "1e-999", "\"1e-999\"", beyond),
                bad_force("hexadecimal", "0x1p3", "\"0x1p3\"", "write it in decimal"),
                bad_force("text", "n/a", "\"n/a\"", repair),
                bad_force("quoted number", "\"0.5\"", "quotes around 0.5", "remove the quotes"),
                bad_force("lone quote", "\"0.5", "\"\"0.5\"", repair),
                bad_force("empty field", "", "an empty field", "fill in the value or remove the row"),
                bad_force("blank field", "   ", "an empty field", "fill in the value or remove the row"),
                bad_force("two numbers", "0.5 0.6", "\"0.5 0.6\"", repair),
                bad_force("two signs", "+-0.5", "\"+-0.5\"", repair),
                bad_force("two points", "0.5.1", "\"0.5.1\"", repair),
                bad_force("exponent without digits", "1e", "\"1e\"", repair),
                bad_force("unit behind the number", "  0.5 N", "\"0.5 N\"", repair, 15),
                bad_force("escape sequence", "\x1B[2J", "\"\\x1b[2J\"", repair),
                bad_force("Arabic digits", "\xD9\xA1", "\"\xD9\xA1\"", repair),
                bad_force("byte outside UTF-8", "0\xFF", "\"0\\xff\"", repair),
                bad_force("long garbage", std::string(60, 'z'), "\""s + std::string(40, 'z') + "...\"", repair),
                {"NaN in an optional column", "velocity_m_per_s,time_s,position_m,force_N\n0,0,0,0\nnan,0.001,0,0\n",
                 "rec.csv:3:1: found \"nan\", expected a finite number in velocity_m_per_s; remove the row "
                 "or repair the value"}});
}

void add_times(std::vector<BrokenRecording>& table) {
  const std::string divide = ", divide it by ";
  table.insert(table.end(),
               {{"time stands still", with_row("0.002,0.001,0.5"),
                 "rec.csv:5:1: found time_s 0.002 after 0.002, expected a later time in every row; remove "
                 "the repeated row or write time_s with more digits"},
                {"time runs backwards", with_row("0.001,0.001,0.5"),
                 "rec.csv:5:1: found time_s 0.001 after 0.002, expected a later time in every row; sort the "
                 "rows, or split the file where time starts again"},
                {"time in another column runs backwards", "force_N,position_m,time_s\n0,0,5\n0,0, 4\n",
                 "rec.csv:3:6: found time_s 4 after 5, expected a later time in every row; sort the rows, "
                 "or split the file where time starts again"},
                {"time in milliseconds", with_step(20, 1, ""),
                 "rec.csv:2:1: found a median time step of 1 s (1 Hz), expected 10 Hz to 20 kHz; if time_s "
                 "is in milliseconds" +
                     divide + "1000, otherwise record faster"},
                {"time in microseconds", with_step(2000, 1000, ""),
                 "rec.csv:2:1: found a median time step of 1e+03 s (0.001 Hz), expected 10 Hz to 20 kHz; if "
                 "time_s is in microseconds" +
                     divide + "1000000, otherwise record faster"},
                {"time in nanoseconds", with_step(20, 1000000, ""),
                 "rec.csv:2:1: found a median time step of 1e+06 s (1e-06 Hz), expected 10 Hz to 20 kHz; if "
                 "time_s is in nanoseconds" +
                     divide + "1000000000, otherwise record faster"},
                {"time in centuries", with_step(20, 1000000, "e5"),
                 "rec.csv:2:1: found a median time step of 1e+11 s (1e-11 Hz), expected 10 Hz to 20 kHz; "
                 "record faster, or check that time_s is in seconds"},
                {"40 kHz", with_step(1500, 25, "e-6"),
                 "rec.csv:2:1: found a median time step of 2.5e-05 s (4e+04 Hz), expected 10 Hz to 20 kHz; "
                 "keep fewer samples, or check that time_s is in seconds"},
                {"nine rows", good_header() + good_rows(9),
                 "rec.csv:11:1: found 9 rows, expected at least 10; record for longer"},
                {"one row and blank lines", good_header() + good_rows(1) + "\n\n",
                 "rec.csv:5:1: found 1 row, expected at least 10; record for longer"},
                {"position in millimetres", with_row("0.003,12.5,0.5"),
                 "rec.csv:5:7: found position_m 12.5, expected metres from the surface, at most 1 either "
                 "way; if it is in millimetres, divide it by 1000"},
                {"force beyond reason", with_row("0.003,0.001,-2e6"),
                 "rec.csv:5:13: found force_N -2e+06, expected newtons, at most 1000000 either way; check "
                 "the unit of the column"}});
}

}  // namespace

std::string good_header() { return "time_s,position_m,force_N\n"; }

std::string good_rows(int count, int first, const std::string& line_end) {
  std::string text;
  for (int i = first; i < first + count; ++i) {
    const std::string digits = std::to_string(1000 + i);
    text += "0." + digits.substr(1) + ",0.001,0.5" + line_end;
  }
  return text;
}

std::string good_recording() { return good_header() + good_rows(12); }

const std::vector<BrokenRecording>& broken_recordings() {
  static const std::vector<BrokenRecording> table = [] {
    std::vector<BrokenRecording> all;
    add_headers(all);
    add_bytes(all);
    add_fields(all);
    add_numbers(all);
    add_times(all);
    return all;
  }();
  return table;
}

}  // namespace palpate::test
