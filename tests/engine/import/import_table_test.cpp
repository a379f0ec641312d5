// Tables in the formats of rigs, and tables that only one reading explains, or none. All tables are made up.
#include "engine/import/import_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>

#include "engine/base/text.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

const std::string kFiles = std::string(PALPATE_SOURCE_DIR) + "/tests/engine/import/files";

// One press of 24 rows: the content of every file.
RecordingRow press_row(std::size_t i) {
  RecordingRow row;
  row.time_s = 0.02 * static_cast<double>(i);
  const double d = 4.0 * std::sin(std::numbers::pi * row.time_s / 0.48) - 1.0;
  row.position_m = 1e-3 * d;
  row.force_N = d > 0.0 ? 0.4 * d + 0.05 * d * d : 0.0;
  return row;
}

// "--columns time=1 --units mm,N --rate 100 ...", as on the command line.
ImportRequest request_of(const std::string& options) {
  ImportRequest made;
  std::vector<std::string> words(1);
  for (const char c : options) c == ' ' ? words.emplace_back() : words.back() += c;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    const std::string &name = words[i], value = words[i + 1] + ",";
    const auto each = [&](const std::function<void(const std::string&)>& take) {
      for (std::size_t at = 0, end; (end = value.find(',', at)) != std::string::npos; at = end + 1)
        take(value.substr(at, end - at));
    };
    if (name == "--units") each([&](const std::string& unit) { made.units.push_back(find_unit(unit).value()); });
    if (name == "--columns") {
      each([&](const std::string& one) {
        for (std::size_t role = 0; role < kRoles; ++role)
          if (one.starts_with(kRoleNames[role])) made.columns[role] = one.substr(one.find('=') + 1);
      });
    }
    if (name == "--rate") made.rate_Hz = std::stod(value);
    if (name == "--gain") made.gain_N_per_V = std::stod(value);
    if (name == "--block") made.block = std::stoul(value);
    if (name == "--skip-bad-rows") made.skip_bad_rows = std::stoul(value);
    if (name == "--rows") made.rows = LineRange{std::stoul(value), std::stoul(value.substr(value.find('-') + 1))};
    if (name == "--flip") (value == "force," ? made.flip_force : made.flip_position) = true;
  }
  made.command = "palpate import rig.txt" + (options.empty() ? "" : " " + options);
  return made;
}

Result<ImportedTable> import_bytes(const std::string& bytes, const std::string& options = "") {
  const test::TemporaryFolder folder;
  const ImportRequest request = request_of(options);
  auto table = import_table(folder.with_file("rig.txt", bytes), request);
  if (!table) return Error{test::replaced(table.error().message, folder.path() + "/", "")};
  return table;
}

std::string message(const std::string& bytes, const std::string& options = "") {
  return test::message_of(import_bytes(bytes, options));
}

TEST(ImportTable, ReadsTheSamePressFromEveryRig) {
  std::map<std::string, std::string> options = {
      {"01_labview.lvm", "--units mm,N"},
      {"03_rostopic.csv", "--columns force=field.wrench.force.z --units m,N"},
      {"04_ros2bag.csv", "--units N"},
      {"09_arduino.txt", "--columns time=1,position=2,force=3 --units ms,mm,g"},
      {"10_ati.csv", "--columns force=4 --flip force"},  // the axis of the sensor points inward
      {"19_rate.csv", "--rate 50"},
      {"20_bare.txt", "--columns time=1,position=2,force=3 --units s,mm,N"},
      {"22_outward.csv", "--flip position"},  // a height above the table
  };
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFiles)) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md") continue;
    SCOPED_TRACE(name);
    ++files;
    const Result table = test::must(import_table(entry.path().string(), request_of(options[name])));
    ASSERT_EQ(table->recording.rows.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i) {
      const RecordingRow expected = press_row(i);
      const RecordingRow& row = table->recording.rows[i];
      // Half a unit of the last printed digit: 0.5 ms, 0.5 um, 0.005 gram-force.
      EXPECT_NEAR(row.time_s, expected.time_s, 0.6e-3) << i;
      EXPECT_NEAR(row.position_m, expected.position_m, 0.6e-6) << i;
      EXPECT_NEAR(row.force_N, expected.force_N, 0.6e-4) << i;
    }
  }
  EXPECT_EQ(files, 23);
}

constexpr int kRows = 200;
constexpr double kStep_s = 0.01;
double position_mm(int i) { return 3.0 - 4.0 * std::cos(0.05 * i); }
double force_N(int i) { return 1.5 * std::max(0.0, position_mm(i)); }

// A header and rows made from a pattern: %t time in s, %m in ms, %u in min, %k in 100 ns, %c 12:30:00.010, %x position
// in mm, %f force in N, %g in mN, %s whole seconds, %p ms of the second, %b 1 and 2 by turns, %i the row.
std::string table_of(const std::string& header, const std::string& pattern, int from = 0, int to = kRows) {
  std::string text = header.empty() ? "" : header + "\n";
  const auto padded = [](int value, std::size_t digits) {
    const std::string plain = std::to_string(value);
    return std::string(digits - std::min(digits, plain.size()), '0') + plain;
  };
  for (int i = from; i < to; ++i) {
    const double t = kStep_s * (i - from);
    const int ms = 10 * (i - from);
    const std::map<char, std::string> cells = {{'t', fixed(t, 2)},
                                               {'m', std::to_string(ms)},
                                               {'u', fixed(t / 60.0, 7)},
                                               {'k', std::to_string(638450000000000000LL + 10000LL * ms)},
                                               {'c', "12:30:" + padded(ms / 1000, 2) + "." + padded(ms % 1000, 3)},
                                               {'s', std::to_string(1700000000 + ms / 1000)},
                                               {'p', std::to_string(ms % 1000)},
                                               {'x', fixed(position_mm(i), 3)},
                                               {'f', fixed(force_N(i), 3)},
                                               {'g', fixed(1e3 * force_N(i), 1)},
                                               {'b', i % 2 == 0 ? "1" : "2"},
                                               {'i', std::to_string(i)}};
    for (std::size_t at = 0; at < pattern.size(); ++at)
      text += pattern[at] != '%' ? std::string(1, pattern[at]) : cells.at(pattern[++at]);
    text += "\n";
  }
  return text;
}

const std::string kHeader = "Time (s),Position (mm),Force (N)";
const std::string kPlain = table_of(kHeader, "%t,%x,%f");
std::string rows_of(int from, int to) { return table_of("", "%t,%x,%f", from, to); }

// Each table has one reading, and its numbers are those of the press.
TEST(ImportTable, OneReadingIsImported) {
  struct Case {
    const char* what;
    std::string text, options;
  };
  const Case cases[] = {
      {"plain", kPlain, ""},
      {"seconds and nanoseconds", table_of("secs,nsecs,position_mm,force_N", "%s,%p000000,%x,%f"), ""},
      {"seconds and milliseconds", table_of("Seconds,Milliseconds,x (mm),F (N)", "%s,%p,%x,%f"), ""},
      {"ticks of 100 ns since the year 1", table_of("Timestamp,x_mm,F_N", "%k,%x,%f"), ""},
      {"an equal second clock", table_of("time,F_N,time.1,x_mm", "%t,%f,%t,%x"), "--units s"},
      {"the arrival before the board's own time", table_of("PC time,millis,x_mm,F_N", "12:31:07,%m,%x,%f"), ""},
      {"arrivals of a terminal", table_of("12:30:00.1 -> t_ms,x_mm,F_N", "%c -> %m,%x,%f"), ""},
      {"durations of pandas", table_of("time,x_mm,F_N", "0 days %c,%x,%f"), ""},
      {"datetime of MATLAB", table_of("Time,x_mm,F_N", "05-Mar-2024 %c,%x,%f"), ""},
      {"units in the cells", table_of("Time,Position,Force", "%t s,%x mm,%g mN"), ""},
      {"a column of units", table_of("Force,Unit,Travel,Unit,Time (s)", "%g,mN,%x,mm,%t"), ""},
      {"a minus sign of a typesetter", replaced(kPlain, "-", "\xE2\x88\x92"), ""},
      {"exponents of Fortran", table_of(kHeader, "%tD+00,%xD+00,%fD+00"), ""},
      {"lines that end with CR", replaced(kPlain, "\n", "\r") + "\n", ""},
      {"the numbers of columns that are also cells", table_of("", "2,%t,%x,%f"),
       "--columns time=2,position=3,force=4 --units s,mm,N"},
      {"a constant column", table_of("Time (s),Distance (mm),Height (mm),F (N)", "%t,%x,12.0,%f"), ""},
      {"bars between the fields", replaced(kPlain, ",", " | "), ""},
      {"decimal commas between quotes",
       replaced(table_of("\"t (s)\",\"x (mm)\",\"F (N)\"", "\"%t\",\"%x\",\"%f\""), ".", ","), ""},
      {"two clocks with the same times", table_of("Time_P (s),x (mm),Time_F (s),F (N)", "%t,%x,%t,%f"), ""},
      {"a torque", table_of("t (s),z (mm),torque_nm,Mz (Nm),Fz (N)", "%t,%x,%f1,%f2,%f"), ""},
      {"a robot", table_of("t_s,z_mm,F_N", "%t,%x,%f"), ""},
      {"a chosen block", table_of(kHeader, "%t,9,9", 0, 20) + "\n" + kPlain, "--block 2"},
      {"chosen lines", table_of(kHeader, "%t,9,9", 0, 20) + rows_of(0, kRows), "--rows 22-221"},
      {"intervals of LabVIEW",
       "LabVIEW Measurement\nX_Columns\tNo\nDelta_X\t0.01\t0.01\nX0\t0\t0\nX_Value\tF (N)\tx (mm)\n" +
           table_of("", "\t%f\t%x"),
       ""},
      {"names of R", table_of("Time..s.,Position..mm.,Normal.Force..N.", "%t,%x,%f"), ""},
      {"a date between tabs", table_of("Time\tx (mm)\tF (N)", "2024-03-05 %c\t%x\t%f"), ""},
      {"a remark that is left out",
       table_of(kHeader, "%t,%x,%f", 0, 8) + "event: hold\n" + replaced(kPlain, kHeader + "\n" + rows_of(0, 8), ""),
       "--skip-bad-rows 1"},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.what);
    const Result table = test::must(import_bytes(one.text, one.options));
    const auto& rows = table->recording.rows;
    ASSERT_EQ(rows.size(), static_cast<std::size_t>(kRows)) << joined(row_words(*table), "\n");
    for (int i = 0; i < kRows; ++i) {
      const RecordingRow& row = rows[static_cast<std::size_t>(i)];
      EXPECT_NEAR(row.time_s, kStep_s * i, 1e-6) << i;
      EXPECT_NEAR(row.position_m, 1e-3 * position_mm(i), 1e-6) << i;
      EXPECT_NEAR(row.force_N, force_N(i), 1e-3) << i;
    }
  }
}

// The whole error: what was found, and every reading that remains.
TEST(ImportTable, OtherwiseTheReadingsThatRemainAreCommands) {
  struct Case {
    std::string text, options, error;
  };
  const std::string command = "\n  palpate import rig.txt ";
  const std::string blocks = "found numbers in 2 blocks, expected one table that explains every row; choose the rows";
  const Case cases[] = {
      {table_of(kHeader, "%t,%x,%f", 0, 60) + kPlain, "",
       "rig.txt: " + blocks + command + "--block 1  # lines 2 to 61: 60 rows of 3 fields" + command +
           "--block 2  # lines 63 to 262: 200 rows of 3 fields"},
      {"2020,3,2,12,30,45\n" + table_of("", "%x,%f"), "--columns position=1,force=2",
       "rig.txt: " + blocks + "\n  line 1: 1 row of 6 fields, too few for a recording" + command +
           "--columns position=1,force=2 --block 2  # lines 2 to 201: 200 rows of 2 fields"},
      {kHeader + "\n1,2,3\n" + rows_of(0, kRows), "",
       "rig.txt: " + blocks + "\n  line 2: 1 row of 3 fields, too few for a recording" + command +
           "--block 2  # lines 3 to 202: 200 rows of 3 fields"},
      {table_of(kHeader, "%t,%x,%f", 0, 8) + "event: hold\n" + rows_of(8, 60), "",
       "rig.txt: " + blocks + command + "--skip-bad-rows 1  # all rows, without the text between them" +
           "\n  lines 2 to 9: 8 rows of 3 fields, too few for a recording" + command +
           "--block 2  # lines 11 to 62: 52 rows of 3 fields"},
      {kPlain + rows_of(60, 100), "",
       "rig.txt:202: found a time 1.99 s before that of the row above \"Time (s)\", expected later times in every row; "
       "choose the rows" +
           command + "--rows 2-201  # times that do not go back" + command +
           "--rows 202-241  # times that do not go back"},
      {table_of("Time,x_mm,F_N", "%u,%x,%f"), "",
       "rig.txt: found no unit of the time \"Time\" and steps of 0.0001667, expected one of s, ms, us, ns, ticks, min, "
       "h, days; add it with --units, or --rate HZ if the rows are evenly spaced" +
           command + "--units s  # 5998.8 Hz" + command + "--units min  # 99.98 Hz"},
      {table_of("Time,x_mm,F_N", "12:30:00:%m,%x,%f"), "",
       "rig.txt:2: found the time \"12:30:00:0\", which is no number and no time that is understood; write seconds "
       "(0.010), or hours:minutes:seconds with a decimal mark (14:03:22.010), or, if the rows are evenly spaced, add "
       "--rate HZ"},
      {table_of("host_s,t_us,x_mm,F_N", "%i,%m000,%x,%f"), "",
       "rig.txt: found two clocks that differ by up to 197.01 s, in columns 2 \"t_us\" and 1 \"host_s\", expected one; "
       "choose the time" +
           command + "--columns time=2  # \"t_us\": 1.99 s" + command + "--columns time=1  # \"host_s\": 199 s"},
      {"X_Columns\tNo\nDelta_X\t0.01\t0.015\nX0\t0\t0\nX_Value\tF (N)\tx (mm)\n" + table_of("", "\t%f\t%p"), "",
       "rig.txt: found two clocks, with a position every 0.015 s from 0 s on and a force every 0.01 s from 0 s on, "
       "expected one, or a position that is fast enough to be interpolated; export both channels with one interval"},
      {table_of("specimen,t_s,x_mm,F_N", "%b,%t,%x,%f"), "",
       "rig.txt: found rows of 2 series that alternate, by column 1 \"specimen\" (1, 2), expected one; write the rows "
       "of each into a file of its own"},
      {replaced(table_of("specimen,x_mm,F_N", "A,%x,%f", 0, 30) + table_of("", "B,%x,%f", 30, 60), "\n\n", "\n"),
       "--rate 100",
       "rig.txt: found rows of 2 series, by column 1 \"specimen\", expected one; choose the rows" + command +
           "--rate 100 --rows 2-31  # A" + command + "--rate 100 --rows 32-61  # B" + command +
           "--rate 100 --rows 2-61  # all as one recording"},
      {"Time (s),Position (m),Force (N)\ns,mm,N\n" + rows_of(0, kRows), "",
       "rig.txt:1: found two units of the position \"Position (m)\", m and mm, expected one; correct the header, or "
       "give the unit of the numbers" +
           command + "--units m  # the first" + command + "--units mm  # the second"},
      {table_of("t_s,x_mm,force_N (mN)", "%t,%x,%g"), "",
       "rig.txt:1: found two units of the force \"force_N (mN)\", mN and N, expected one; correct the header, or give "
       "the unit of the numbers" +
           command + "--units mN  # the first" + command + "--units N  # the second"},
      {table_of("t_s,x_mm,a (g)", "%t,%x,%f"), "",
       "rig.txt: found no column that is clearly the force, expected one column for each of time, position and force; "
       "the columns are 1 \"t_s\", 2 \"x_mm\", 3 \"a (g)\"" +
           command + "--columns force=3  # \"a (g)\""},
      {replaced(replaced(table_of("Time (s),x_mm,F_N", "14035%t,%x,%f"), "140350.", "140359."), "140351.", "140400."),
       "",
       "rig.txt:102: found a time 40.01 s after that of the row above \"Time (s)\" at a multiple of 100 s, as where "
       "hours, minutes and seconds are written as one number; write seconds, or 14:03:22.010"},
      {kHeader + "\nScale,0.5,2.5\n" + rows_of(0, kRows), "",
       "rig.txt:2: found \"Scale,0.5,2.5\", which has the numbers of a row and is none of the table; correct the line, "
       "or "
       "leave it out" +
           command + "--rows 3-202  # without such lines"},
      {kPlain + "t:2.00, x:1.0, F:1.0\n", "",
       "rig.txt:202: found \"t:2.00, x:1.0, F:1.0\", which has the numbers of a row and is none of the table; correct "
       "the "
       "line, or leave it out" +
           command + "--rows 2-201  # without such lines"},
      {table_of("Time (ms),x_mm,F_N", "%c,%x,%f"), "",
       "rig.txt: found times of a clock in the time \"Time (ms)\", expected numbers in ms, as the header says" +
           command + "--units s  # the times of the clock"},
      {table_of("src,x_mm,F_N", "1,%x,%f\n2,%f,%x"), "--rate 100",
       "rig.txt: found rows of 2 series that alternate, by the position \"x_mm\", which is nearer to that 2 rows above "
       "than to that of the row above (or a disturbance has this period), expected one; write the rows of each into a "
       "file of its own"},
      {table_of("Force,Unit,x (mm),t (s)", "%g,mN,%x,%t"), "--units N",
       "rig.txt: found the unit mN in the rows of the force \"Force\", expected N, as --units says; correct the one "
       "that is wrong"},
      {table_of("t_s,x_mm,fsr,accel_z_g", "%t,%x,%i,%f"), "",
       "rig.txt: found no column that is clearly the force, expected one column for each of time, position and force; "
       "the columns are 1 \"t_s\", 2 \"x_mm\", 3 \"fsr\", 4 \"accel_z_g\"" +
           command + "--columns force=3  # \"fsr\""},
      {kPlain.substr(0, kPlain.size() - 7), "",
       "rig.txt:201: found \"1.99,6.461\", expected a row of 3 fields" + command +
           "--skip-bad-rows 1  # without 1 such row; the other rows keep their times"},
      {table_of("x (mm),F (N)", "%x,%f", 0, 40) + "1.0,OL\n" + table_of("", "%x,%f", 40, 60), "--rate 100",
       "rig.txt:42: found \"OL\" in column 2 \"F (N)\", expected a number; repair the value, or leave the row out" +
           command + "--rate 100 --skip-bad-rows 1  # without 1 such row; the other rows keep their times"},
      {"time,position,force\ntime,force,position\n" + rows_of(0, kRows), "",
       "rig.txt:1: found names of columns in this line and in line 2, expected one header with a name for each field; "
       "correct it, or say which column is which by their numbers: --columns time=N,position=N,force=N"},
      {table_of("Time (s),Weg (mm),Load (stone)", "%t,%x,%f"), "",
       "rig.txt:1: found the unit \"stone\" in column 3 \"Load (stone)\", expected a unit of force (N, mN, uN, nN, pN, "
       "cN, dN, daN, kN, g, kg, ozf, lbf, kip); convert the column, choose another with --columns force=NAME, or give "
       "the unit of the numbers with --units"},
      {table_of("t_s,LVDT (mm),Crosshead (mm),F_N", "%t,%x,1%x,%f"), "",
       "rig.txt: found 2 columns that can be the position, expected one column for each of time, position and force; "
       "the "
       "columns are 1 \"t_s\", 2 \"LVDT (mm)\", 3 \"Crosshead (mm)\", 4 \"F_N\"" +
           command + "--columns position=2  # \"LVDT (mm)\"" + command + "--columns position=3  # \"Crosshead (mm)\""},
      {table_of("t,x_mm,F_N", "%i,%x,%f"), "",
       "rig.txt: found no unit of the time \"t\" and steps of 1, expected one of s, ms, us, ns, ticks, min, h, days; "
       "add "
       "it with --units, or --rate HZ if the rows are evenly spaced" +
           command + "--units ms  # 1000 Hz"},
      {replaced(kPlain, "0.51,", "0.50,"), "",
       "rig.txt: found the time of the row above \"Time (s)\" in 1 row with other values, expected a later time in "
       "every "
       "row; write the times with more digits" +
           command + "--rate 100  # the mean rate, if the rows are evenly spaced" + command +
           "--skip-bad-rows 1  # without these rows"},
      {table_of("Zeit (ms);Weg (um);F (mN)", "%m;2.%i;3.%i", 100, 190), "",
       "rig.txt: found numbers such as 3.189, whose point may be a decimal mark or a thousands mark; add --decimal "
       "point, "
       "or export the numbers without thousands marks"},
      {"only words\nand more\n", "",
       "rig.txt: found no rows of numbers in the first 2 lines, such as \"and more\", expected a table with columns of "
       "time, position and "
       "force; export the recording as CSV"},
  };
  for (const Case& one : cases) EXPECT_EQ(message(one.text, one.options), one.error);
  for (const char* name : {"Force*100 (N)", "Force (N) x100", "10 x Force (N)", "F_x10_N", "Force/10 (N)", "F 10^-2 N"})
    EXPECT_TRUE(
        test::has_parts(message(table_of(std::string("t_s,x_mm,") + name, "%t,%x,%f")), {"the unit", "convert"}))
        << name;
  const std::string wraps = message(table_of("t_ms,x_mm,F_N", "%i0,%x,%f", 6450, 6554) + "4,1,1\n14,1,1\n");
  EXPECT_TRUE(test::has_parts(wraps, {"a counter of 16 bits begins again"})) << wraps;
  EXPECT_NE(message(""), "accepted");
  EXPECT_NE(message("PK\x03\x04rest"), "accepted");
}

// A row that is left out leaves its time.
TEST(ImportTable, ARowThatIsLeftOutLeavesItsTime) {
  std::string text = "x (mm),F (N)\n";
  for (int i = 0; i < 100; ++i)
    text += fixed(position_mm(i), 3) + (i >= 40 && i < 50 ? ",OL\n" : "," + fixed(force_N(i), 3) + "\n");
  const Result table = test::must(import_bytes(text, "--rate 100 --skip-bad-rows 10"));
  ASSERT_EQ(table->recording.rows.size(), 90u);
  EXPECT_NEAR(table->recording.rows.back().time_s, 0.99, 1e-9);
  ASSERT_EQ(table->left_out.size(), 1u);
  EXPECT_EQ(row_words(*table),
            (std::vector<std::string>{"90 read, lines 2 to 101", "left out 10 rows (unreadable), lines 42 to 51"}));
  // Also a row without any value, a line of text and an empty line, and one that only a count of the rows shows.
  for (const char* lost : {"nan,nan", "overload", ""}) {
    std::string all = "x (mm),F (N)\n";
    for (int i = 0; i < 100; ++i)
      all += (i >= 40 && i < 50 ? lost : fixed(position_mm(i), 3) + "," + fixed(force_N(i), 3)) + "\n";
    EXPECT_NE(message(all, "--rate 100"), "accepted") << lost;
    const Result kept = test::must(import_bytes(all, "--rate 100 --skip-bad-rows 10"));
    EXPECT_EQ(kept->recording.rows.size(), 90u) << lost;
    EXPECT_NEAR(kept->recording.rows.back().time_s, 0.99, 1e-9) << lost;
  }
  const std::string counted = table_of("seq,x (mm),F (N)", "%i,%x,%f", 0, 40) + table_of("", "%i,%x,%f", 50, 100);
  const Result counts = test::must(import_bytes(counted, "--rate 100"));
  EXPECT_NEAR(counts->recording.rows.back().time_s, 0.99, 1e-9);
  EXPECT_TRUE(test::has_parts(joined(counts->notes), {"counts the rows and skips 10 of them"}));
  std::string coarse = "Time;x (mm);F (N)\n";
  for (int i = 0; i < 200; ++i)
    coarse += "12:30:" + std::to_string(10 + i / 20) + ";" + std::to_string(i) + ";" +
              (i == 30 ? "OL" : std::to_string(i)) + "\n";
  const std::string refused = message(coarse, "--skip-bad-rows 1");
  EXPECT_TRUE(test::has_parts(refused, {"in 189 rows with other", "--skip-bad-rows 1 --rate 20  # the mean rate"}))
      << refused;
  const Result clock = test::must(import_bytes(coarse, "--skip-bad-rows 1 --rate 20"));
  EXPECT_NEAR(clock->recording.rows.back().time_s, 9.95, 1e-9);
}

// Two clocks become that of the faster channel where the slower one can be interpolated, and keep their offset.
TEST(ImportTable, TwoExplicitClocksBecomeOne) {
  std::string text = "Time_P (s),x (mm),Time_F (s),F (N)\n";
  const auto x_mm = [](double t) { return 3.0 - 3.0 * std::cos(4.0 * t); };
  for (int i = 0; i < 400; ++i)
    text += (i < 200 ? fixed(0.004 + 0.02 * i, 3) + "," + fixed(x_mm(0.004 + 0.02 * i), 4) : std::string(",")) + "," +
            fixed(0.01 * i, 2) + "," + fixed(2.0 * x_mm(0.01 * i), 4) + "\n";
  const Result table = test::must(import_bytes(text));
  const auto& rows = table->recording.rows;
  ASSERT_EQ(rows.size(), 398u);
  for (const RecordingRow& row : rows) EXPECT_NEAR(2e3 * row.position_m, row.force_N, 0.03) << row.time_s;
  EXPECT_EQ(row_words(*table).back(), "left out 2 rows (without a position at the time), lines 2 to 401");
  EXPECT_TRUE(test::has_parts(joined(table->notes), {"warning: found two clocks", "the position is interpolated"}));
}

TEST(ImportTable, DayAndMonthAreDecidedOnceForTheColumn) {
  for (const char* form : {"12/03/2024 23:59:%;13/03/2024 00:00:%", "03/12/2024 23:59:%;03/13/2024 00:00:%"}) {
    const std::string both = form, before = both.substr(0, both.find(';')), after = both.substr(before.size() + 1);
    std::string text = "Timestamp,x (mm),F (N)\n";
    for (int i = 0; i < 120; ++i)
      text += replaced(i < 60 ? before : after, "%", fixed(i < 60 ? 54.0 + 0.1 * i : 0.1 * (i - 60), 3)) + "," +
              std::to_string(i) + ",2" + std::to_string(i) + "\n";
    const Result table = test::must(import_bytes(replaced(text, ":0.", ":00.")));
    EXPECT_NEAR(table->recording.rows.back().time_s, 11.9, 1e-6) << form;
  }
}

TEST(ImportTable, TheLimitsAreThoseAfterTheCorrections) {
  Result table = test::must(import_bytes(table_of("t_s,z_m,F_N", "%t,1.2%i,%f", 10, 99)));
  const ImportRequest request = request_of("--out r.csv");
  EXPECT_EQ(
      check_limits("rig.txt", request, *table).error().message,
      "rig.txt: found the position 1.298 m, expected metres from the surface, at most 1 either way; move position "
      "0\n  palpate import rig.txt --out r.csv --zero contact  # where the force begins\n"
      "  palpate import rig.txt --out r.csv --zero first  # the first row");
  for (RecordingRow& row : table->recording.rows) row.position_m -= 1.25;
  EXPECT_TRUE(check_limits("rig.txt", request, *table).ok());
}

TEST(ImportTable, KeepsTheVelocityOfARecording) {
  const auto table =
      test::must(import_bytes(table_of("time_s,position_m,force_N,velocity_m_per_s", "%t,0.00%i,%f,0.1%i", 10, 99)));
  EXPECT_TRUE(table.recording.columns.velocity);
  EXPECT_NEAR(table.recording.rows[2].velocity_m_per_s, 0.112, 1e-12);
}

TEST(ImportTable, AGainOrAUnitOfTheUserOverridesTheHeaderWithAWarning) {
  const auto volts = test::must(import_bytes(table_of("t_s,x_mm,F (N)", "%t,%x,%f"), "--gain 2"));
  EXPECT_NEAR(volts.recording.rows.back().force_N, 2.0 * force_N(kRows - 1), 1e-3);
  EXPECT_TRUE(test::has_parts(joined(volts.notes), {"warning: the force", "in V as --gain says", "its header says N"}));
  const auto stone = test::must(import_bytes(table_of("t_s,x_mm,F (stone)", "%t,%x,%f"), "--units N"));
  EXPECT_TRUE(test::has_parts(joined(stone.notes), {"warning", "read in N as --units says", "stone"}));
}

}  // namespace
}  // namespace palpate
