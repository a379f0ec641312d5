#include "tests/support/broken_recordings.h"

namespace palpate::test {
namespace {

using namespace std::string_literals;

using Table = std::vector<BrokenRecording>;

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

Table broken_headers() {
  const std::string rows = good_rows(12);
  return {
      {"empty", "", "1:1", {"empty", "time_s", "position_m", "force_N"}},
      {"only a byte order mark", "\xEF\xBB\xBF", "1:1", {"empty", "time_s", "position_m", "force_N"}},
      {"only comments", "# one\n# two\n", "3:1", {"end of the file", "time_s", "position_m", "force_N"}},
      {"blank first line", "\n"s + good_header() + rows, "1:1", {"blank line", "time_s", "blank line"}},
      {"no header", rows, "1:1", {"numbers", "time_s", "header", "palpate import"}},
      {"missing column", "time_s,position_m\n0,0\n", "1:1", {"time_s,position_m", "force_N", "palpate import"}},
      {"two missing", "# c\ntime_s,x,f\n0,0,0\n", "2:1", {"time_s,x,f", "position_m and force_N", "palpate import"}},
      {"unknown columns only",
       "a,b,c\n1,2,3\n",
       "1:1",
       {"a,b,c", "time_s and position_m and force_N", "palpate import"}},
      {"duplicate column", "time_s,position_m,force_N,position_m\n0,0,0,0\n", "1:27", {"position_m", "once"}},
      {"duplicate optional column",
       "time_s,velocity_m_per_s,position_m,force_N,velocity_m_per_s\n",
       "1:44",
       {"velocity_m_per_s", "once"}},
      {"quoted", "\"time_s\",\"position_m\",\"force_N\"\n" + rows, "1:1", {"'\"time_s\"'", "time_s", "palpate import"}},
      {"blank before a name", "time_s, position_m,force_N\n" + rows, "1:9", {"' position_m'", "position_m"}},
      {"other case", "time_s,position_m,Force_n\n" + rows, "1:19", {"'Force_n'", "force_N", "palpate import"}},
      {"semicolons", "time_s;position_m;force_N\n0;0;0\n", "1:7", {"semicolons", "commas", "palpate import"}},
      {"tabs", "time_s\tposition_m\tforce_N\n0\t0\t0\n", "1:7", {"tabs", "commas", "palpate import"}},
      {"Latin-1 header",
       "time_s,position_m,force_N,Kr\xE4"
       "fte\n",
       "1:29",
       {"\\xe4", "UTF-8"}},
      {"overlong UTF-8", "time_s,position_m,force_N,\xC0\xAF\n", "1:27", {"\\xc0", "UTF-8"}},
      {"header only", good_header(), "2:1", {"0 rows", "10"}}};
}

Table broken_bytes() {
  const std::string whole = good_recording();
  return {{"binary", "\x7F"s + "ELF\x02\x01\x01\0\0\0"s, "1:8", {"NUL", "UTF-8"}},
          {"NUL in a row", with_row("0.003,0.0\0,0.5"s), "5:10", {"NUL", "UTF-8"}},
          {"NUL in an ignored column", "time_s,note,position_m,force_N\n0,a\0b,0,0\n"s, "2:4", {"NUL", "UTF-8"}},
          {"UTF-16 little endian", "\xFF\xFEt\0i\0m\0e\0"s, "1:1", {"UTF-16", "UTF-8"}},
          {"UTF-16 big endian", "\xFE\xFF\0t\0i\0m\0e"s, "1:1", {"UTF-16", "UTF-8"}},
          {"UTF-16 without a mark", "t\0i\0m\0e\0"s, "1:2", {"NUL", "UTF-16"}},
          {"CR only", all_lines(whole, "\n", "\r"), "1:26", {"carriage return", "LF or CRLF"}},
          {"CR behind a comment", all_lines("# c\n" + whole, "\n", "\r"), "1:4", {"carriage return", "LF or CRLF"}},
          {"CR-only rows", good_header() + all_lines(good_rows(12), "\n", "\r"), "2:16", {"carriage return", "LF"}},
          {"gigantic header", std::string(70000, 'x'), "1:65537", {"65536 bytes", "row"}},
          {"long behind a mark", "\xEF\xBB\xBF#" + std::string(65536, ' ') + "\n" + whole, "1:65537", {"65536 bytes"}},
          {"gigantic comment", "#" + std::string(3000000, ' ') + "\n" + whole, "1:65537", {"65536 bytes", "row"}},
          {"gigantic number", with_row("0.003,0.001," + std::string(65536, '1')), "5:65537", {"65536 bytes", "row"}},
          {"gigantic last line", whole + std::string(65537, '0'), "14:65537", {"65536 bytes", "row"}}};
}

Table broken_fields() {
  const std::string whole = good_recording();
  return {{"short row", with_row("0.003,0.001"), "5:12", {"2 fields", "3"}},
          {"one field", with_row("0.003"), "5:6", {"1 field", "3"}},
          {"truncated last row", whole + "0.012,0.00", "14:11", {"2 fields", "file ends", "3", "last line"}},
          {"truncated behind a comma", whole + "0.012,0.001,", "14:13", {"empty field", "force_N"}},
          {"too many fields", with_row("0.003,0.001,0.5,7"), "5:17", {"4 fields", "3", "commas", "column"}},
          {"locale commas", with_row("0,003,0,001,0,5"), "5:9", {"6 fields", "3", "decimal points", "commas"}},
          {"trailing comma", with_row("0.003,0.001,0.5,"), "5:17", {"4 fields", "3", "comma", "row"}},
          {"trailing comma in the header",
           "time_s,position_m,force_N,\n" + good_rows(12),
           "2:16",
           {"4", "comma", "header"}},
          {"quoted locale comma", with_row("0.003,0.001,\"0,5\""), "5:16", {"4 fields", "3", "quotes"}},
          {"semicolons in rows", with_row("0.003;0.001;0.5"), "5:6", {"semicolons", "commas"}},
          {"tabs in rows", with_row("0.003\t0.001\t0.5"), "5:6", {"tabs", "commas"}},
          {"blank line in the middle", with_row(""), "5:1", {"blank line", "3 fields"}},
          {"line of blanks in the middle", with_row(" \t \n\n"), "5:1", {"blank line", "3 fields"}},
          {"comment behind the header", with_row("# pause"), "5:1", {"comment", "row"}},
          {"header again", with_row("time_s,position_m,force_N"), "5:1", {"\"time_s\"", "time_s"}}};
}

// A recording with `field` as a force.
BrokenRecording bad_force(const std::string& field, const std::string& found, const std::string& advice,
                          const char* place = "5:13") {
  return {"force", with_row("0.003,0.001," + field), place, {found, "force_N", "; ", advice}};
}

Table broken_numbers() {
  Table table;
  for (const char* text :
       {"nan", "-NaN", "nan(0x1)", "inf", "-Infinity", "n/a", "0.5 0.6", "+-0.5", "0.5.1", "1e", "\"0.5", "\xD9\xA1"})
    table.push_back(bad_force(text, '"' + std::string(text) + '"', "row"));
  for (const char* text : {"1e999", "-1e400", "1e-999"})
    table.push_back(bad_force(text, '"' + std::string(text) + '"', "double"));
  for (const char* text : {"", "   "}) table.push_back(bad_force(text, "empty field", "value"));
  const Table others = {
      bad_force("0x1p3", "\"0x1p3\"", "decimal"),
      bad_force("\"0.5\"", "quotes around 0.5", "quotes"),
      bad_force("  0.5 N", "\"0.5 N\"", "row", "5:15"),
      bad_force("\x1B[2J", "\"\\x1b[2J\"", "row"),
      bad_force("0\xFF", "\"0\\xff\"", "row"),
      bad_force(std::string(60, 'z'), "\""s + std::string(40, 'z') + "...\"", "row"),
      {"optional", "velocity_m_per_s,time_s,position_m,force_N\n0,0,0,0\nnan,0.001,0,0\n", "3:1", {"nan", "velocity"}}};
  table.insert(table.end(), others.begin(), others.end());
  return table;
}

Table broken_times() {
  return {
      {"time stands still", with_row("0.002,0.001,0.5"), "5:1", {"0.002", "0.002", "later", "repeated"}},
      {"time runs backwards", with_row("0.001,0.001,0.5"), "5:1", {"0.001", "0.002", "later", "sort"}},
      {"time in another column", "force_N,position_m,time_s\n0,0,5\n0,0, 4\n", "3:6", {"4", "5", "later", "sort"}},
      {"milliseconds", with_step(20, 1, ""), "2:1", {"1 s (1 Hz)", "10 Hz", "20 kHz", "milliseconds", "1000"}},
      {"microseconds", with_step(2000, 1000, ""), "2:1", {"(0.001 Hz)", "10 Hz", "20 kHz", "microseconds", "1000000"}},
      {"nanoseconds",
       with_step(20, 1000000, ""),
       "2:1",
       {"(1e-06 Hz)", "10 Hz", "20 kHz", "nanoseconds", "1000000000"}},
      {"centuries", with_step(20, 1000000, "e5"), "2:1", {"(1e-11 Hz)", "10 Hz", "20 kHz", "seconds"}},
      {"40 kHz", with_step(1500, 25, "e-6"), "2:1", {"2.5e-05 s (4e+04 Hz)", "10 Hz", "20 kHz", "fewer"}},
      {"nine rows", good_header() + good_rows(9), "11:1", {"9 rows", "10"}},
      {"one row and blank lines", good_header() + good_rows(1) + "\n\n", "5:1", {"1 row", "10"}},
      {"position in mm",
       with_row("0.003,12.5,0.5"),
       "5:7",
       {"position_m", "12.5", "metres", "1", "palpate import FILE --out REC.csv", "millimetres", "--units mm,N"}},
      {"huge force", with_row("0.003,0.001,-2e6"), "5:13", {"force_N", "-2e+06", "newtons", "1000000", "unit"}}};
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
  static const Table table = [] {
    Table all;
    for (const Table& part : {broken_headers(), broken_bytes(), broken_fields(), broken_numbers(), broken_times()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

}  // namespace palpate::test
