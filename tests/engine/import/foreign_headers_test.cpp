// Names and units above tables: rows of units, status lines, headers that do not fit the rows, unknown units.
#include <gtest/gtest.h>

#include <functional>

#include "engine/import/import_table.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using Cells = std::function<std::string(int row)>;

std::string rows_of(const Cells& cells) {
  std::string text;
  for (int i = 10; i < 30; ++i) text += cells(i) + "\n";
  return text;
}

// Rows of a time in hundredths, a position and a force.
std::string plain_rows(const std::string& separator) {
  return rows_of([&](int i) {
    const std::string n = std::to_string(i);
    return "0." + n + separator + "1." + n + separator + n + ".5";
  });
}

Result<ImportedTable> import_bytes(const std::string& bytes, const ImportRequest& request = {}) {
  const test::TemporaryFolder folder;
  auto table = import_table(folder.with_file("rig.txt", bytes), request);
  if (!table) return Error{test::replaced(table.error().message, folder.path() + "/", "")};
  return table;
}

std::string message(const std::string& bytes, const ImportRequest& request = {}) {
  const auto table = import_bytes(bytes, request);
  return table ? "accepted" : table.error().message;
}

// "time 4 s, position 2 mm, force 3 kN", or the error.
std::string roles(const std::string& bytes) {
  const auto table = import_bytes(bytes);
  if (!table) return table.error().message;
  std::string text;
  for (std::size_t role = 0; role < kRoles; ++role) {
    const ImportedColumn& column = table->columns[role];
    text += (role > 0 ? ", " : "") + std::string(kRoleNames[role]) + " " + std::to_string(column.number) + " " +
            column.unit;
  }
  return text;
}

TEST(ForeignHeaders, AMajorityOfUnitsIsARowOfUnits) {
  const auto five = [](const std::string& mark) {
    return rows_of([&](int i) {
      const std::string n = std::to_string(i);
      return "1" + mark + "0." + n + mark + "0.0" + n + mark + "0." + n + mark + "1";
    });
  };
  EXPECT_EQ(roles("\"Test Run: 1\"\n\"_Cycle\",\"Crosshead \",\"Load \",\"Time \",\"Cycle Channel \"\n"
                  "\"_Cycle\",\"mm\",\"kN\",\"sec\",\"count\"\n" +
                  five(",")),
            "time 4 s, position 2 mm, force 3 kN");
  EXPECT_EQ(roles("Segmente;Weg;Kraft;Zeit;Ausgang\nsegments;mm;N;s;Volts\n" + five(";")),
            "time 4 s, position 2 mm, force 3 N");
  EXPECT_EQ(roles("Points\tExtension\tLoad\tTime\tTemperature\nnone\tin\tlbf\tSec\tdegC\n" + five("\t")),
            "time 4 s, position 2 inch, force 3 lbf");
  const auto rows = rows_of([](int i) { return "1\t2\t0." + std::to_string(i) + "\t1\t2\t3\t4"; });
  EXPECT_EQ(roles("a\tb\tTime\tDisp\tLoad\tc\td\nfoo\tbaz\ts\tcm\tcN\tqux\tquux\n" + rows),
            "time 3 s, position 4 cm, force 5 cN")
      << "below names, some units are enough";
  EXPECT_EQ(roles("s,mm,N\n" + plain_rows(",")), "time 1 s, position 2 mm, force 3 N")
      << "the units are the only names";
}

TEST(ForeignHeaders, AStatusLineIsNoHeader) {
  const std::string expected = "time 1 s, position 2 mm, force 3 g";
  EXPECT_EQ(roles("time(s),position(mm),force(grams)\nTaring, please wait, done\n" + plain_rows(",")), expected);
  EXPECT_EQ(roles("time(s);position(mm);force(grams)\nforce zero position\n" + plain_rows(";")), expected);
  EXPECT_EQ(roles("time_s\tposition_mm\tload_g\nScale: ready\tzero: done\tgain: 128\n\n" + plain_rows("\t")), expected);
  EXPECT_EQ(roles("t(s) pos(mm) force(g)\nHX711 is ready\n" + plain_rows(" ")), expected);
}

TEST(ForeignHeaders, ContradictionsAreRefused) {
  EXPECT_TRUE(
      test::has_parts(message("time,position,force\ntime,force,position\n" + plain_rows(",")),
                      {"rig.txt:1: ", "line 2", "remove the wrong line", "--columns time=N,position=N,force=N"}));
  EXPECT_TRUE(test::has_parts(message("Time (s),Position (N),Force (mm)\n" + plain_rows(",")),
                              {"rig.txt: ", "\"Force (mm)\"", "mm", "--columns position=3"}));
  EXPECT_TRUE(test::has_parts(message("Zeit;Weg;Kraft\ns;N;mm\n" + plain_rows(";")), {"\"Kraft\"", "unit mm"}));
}

TEST(ForeignHeaders, RowsOfAnotherLengthThanTheHeader) {
  const auto longer = [](const std::string& mark) {
    return rows_of([&](int i) {
      const std::string n = std::to_string(i);
      return n + "0000" + mark + n + mark + "1." + n + mark + "-0." + n + mark + n + ".26";
    });
  };
  const std::string names = "time(us),power(pwm),position(mm),force(grams)\n";
  for (const std::string preamble : {"", "Two axis displacement sensor detected\nTareing....\n"}) {
    const std::string line = preamble.empty() ? "1" : "3";
    EXPECT_TRUE(test::has_parts(message(preamble + names + longer(",")),
                                {"rig.txt:" + line + ": ", "4 names (\"time(us)\", \"power(pwm)\"", "5 fields",
                                 "--columns time=N,position=N,force=N", "--units us,mm,g"}));
  }
  EXPECT_TRUE(
      test::has_parts(message("zeit(us);weg(mm);kraft(N)\n" + longer(";")), {"rig.txt:1: ", "3 names", "5 fields"}));
  EXPECT_TRUE(test::has_parts(message("index,time (s),pos (mm),force (N)\n" + plain_rows(",")),
                              {"rig.txt:1: ", "4 names", "3 fields"}));
  ImportRequest numbers;
  numbers.columns = {"1", "3", "5"};
  numbers.units = {*find_unit("us"), *find_unit("mm"), *find_unit("g")};
  const auto table = import_bytes(names + longer(","), numbers);
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_TRUE(test::has_parts(table->notes.front(), {"warning", "line 1", "4 names"}));
}

TEST(ForeignHeaders, AnUnknownUnitIsNamed) {
  for (const char* name : {"Load (stone)", "Load [MPa]", "Force (counts)", "Kraft/hN", "Kraft in Stein", "Load_hN"}) {
    SCOPED_TRACE(name);
    const std::string header = std::string("Time (s);Weg (mm);") + name + "\n";
    const std::string_view whole = name;
    const std::string unit(
        whole.substr(whole.find_last_of("([/ _") + 1, whole.find_last_not_of(")]") - whole.find_last_of("([/ _")));
    EXPECT_TRUE(test::has_parts(message(header + plain_rows(";")),
                                {"rig.txt:1: ", "the unit \"" + unit + "\"", "column 3", "daN", "lbf", "--units"}));
    ImportRequest request;
    request.units = {*find_unit("N")};
    const auto table = import_bytes(header + plain_rows(";"), request);
    ASSERT_TRUE(table.ok()) << table.error().message;
    EXPECT_TRUE(test::has_parts(table->notes.front(), {"warning", "read in N", unit}));
  }
  EXPECT_TRUE(test::has_parts(message("Time (s),Pos (furlong),F (N)\n" + plain_rows(",")), {"\"furlong\"", "mil, ft"}));
  EXPECT_TRUE(test::has_parts(message("Time (fortnight),Pos (mm),F (N)\n" + plain_rows(",")), {"\"fortnight\"", "ms"}));
}

TEST(ForeignHeaders, MoreUnitsAreKnown) {
  const auto last_N = [](const char* unit) {
    const auto table = import_bytes(std::string("t (s),pos (mil),F (") + unit + ")\n" + plain_rows(","));
    EXPECT_TRUE(table.ok()) << table.error().message;
    EXPECT_NEAR(table->recording.rows.back().position_m, 1.29 * 25.4e-6, 1e-12);
    return table->recording.rows.back().force_N;
  };
  EXPECT_DOUBLE_EQ(last_N("daN"), 295.0);
  EXPECT_NEAR(last_N("kp"), 29.5 * 9.80665, 1e-9);
  EXPECT_NEAR(last_N("ozf"), 29.5 * 0.27801385, 1e-6);
  EXPECT_NEAR(last_N("klbf"), 29.5 * 4448.2216152605, 1e-6);
  EXPECT_DOUBLE_EQ(last_N("pN"), 29.5e-12);
}

}  // namespace
}  // namespace palpate
