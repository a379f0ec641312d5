// Rows of tables: slow channels, coarse clocks, two recordings in one file.
#include <gtest/gtest.h>

#include <functional>

#include "engine/base/text.h"
#include "engine/import/import_table.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::string table_of(const std::string& header, int count, const std::function<std::string(int row)>& row) {
  std::string text = header + "\n";
  for (int i = 0; i < count; ++i) text += row(i) + "\n";
  return text;
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

ImportedTable imported(const std::string& bytes, const ImportRequest& request = {}) {
  const auto table = import_bytes(bytes, request);
  EXPECT_TRUE(table.ok()) << table.error().message;
  return table.ok() ? *table : ImportedTable{};
}

std::string all_notes(const ImportedTable& table) { return joined(table.notes, "\n"); }

std::string number(double value) { return general(value, 9); }

TEST(ForeignRows, ASlowChannelIsNamedAndItsFullRowsAreOffered) {
  const auto slow = [](const char* empty, bool writes_empty) {
    return table_of("time (s),pos (mm),force (N)", 200, [&](int i) {
      return number(0.005 * i) + "," + number(0.01 * i) +
             (i % 4 == 0     ? "," + number(0.5 * i)
              : writes_empty ? std::string(",") + empty
                             : "");
    });
  };
  for (const std::string& text : {slow("", true), slow("", false), slow("NaN", true)}) {
    EXPECT_TRUE(test::has_parts(message(text), {"rig.txt: ", "the force in column 3 \"force (N)\" in 150 of 200 rows",
                                                "the 50 full rows", "--skip-bad-rows 150"}));
    ImportRequest request;
    request.skip_bad_rows = 150;
    EXPECT_EQ(imported(text, request).recording.rows.size(), 50u);
  }
  const std::string apart = table_of("time (s);pos (mm);force (N)", 200,
                                     [&](int i) { return number(0.005 * i) + (i % 2 == 0 ? ";1;" : ";;1"); });
  EXPECT_TRUE(test::has_parts(message(apart), {"100 of 200 rows", "no row has both position and force"}));
}

TEST(ForeignRows, ASlowChannelThatNobodyNeedsIsNoFault) {
  const std::string text = table_of("time (s),pos (mm),force (N),temp", 100, [](int i) {
    return number(0.01 * i) + "," + number(0.01 * i) + "," + number(0.5 * i) + (i % 4 == 0 ? ",20" : ",");
  });
  EXPECT_EQ(imported(text).recording.rows.size(), 100u);
}

TEST(ForeignRows, RowsThatShareATimeAreEvenlySpaced) {
  // Every form of a clock: a time of day in whole seconds, tenths of a second, milliseconds.
  const auto of_day = [](int i) { return "9:45:" + std::to_string(10 + i / 12) + " AM"; };
  const auto tenths = [](int i) { return number(0.1 * (i / 50)); };
  const auto milliseconds = [](int i) { return std::to_string(2 * i / 5); };
  struct Case {
    const char* header;
    std::function<std::string(int)> time;
    const char* rate;
    double step_s;
  };
  for (const Case& one : {Case{"Time;Weg (mm);F (N)", of_day, "--rate 12", 1.0 / 12.0},
                          Case{"time (s);pos (mm);force (N)", tenths, "--rate 500", 0.002},
                          Case{"time (ms);pos (mm);force (N)", milliseconds, "--rate 2500", 0.0004}}) {
    SCOPED_TRACE(one.header);
    const ImportedTable table = imported(
        table_of(one.header, 480, [&](int i) { return one.time(i) + ";" + number(0.01 * i) + ";" + number(0.5 * i); }));
    ASSERT_EQ(table.recording.rows.size(), 480u);
    EXPECT_NEAR(table.recording.rows[100].time_s, 100.0 * one.step_s, 1e-12);
    EXPECT_TRUE(test::has_parts(all_notes(table), {"warning: the clock", "have the time of the row above", one.rate}));
  }
}

TEST(ForeignRows, RowsThatShareATimeUnevenlyNeedARate) {
  const auto uneven = table_of("time (s),pos (mm),force (N)", 400, [](int i) {
    return std::to_string(i < 300 ? i / 30 : i / 10) + "," + number(0.01 * i) + "," + number(0.5 * i);
  });
  EXPECT_TRUE(test::has_parts(message(uneven), {"rig.txt: ", "\"time (s)\" in", "of 400 rows", "--rate "}));
  const auto paused = table_of("time (s),pos (mm),force (N)", 400, [](int i) {
    return std::to_string(i / 20 + (i < 200 ? 0 : 5)) + "," + number(0.01 * i) + "," + number(0.5 * i);
  });
  EXPECT_TRUE(test::has_parts(message(paused), {"rig.txt: ", "380 of 400 rows"}));
  // Rows that were written twice.
  const auto twice = table_of("time (s),pos (mm),force (N)", 400, [](int i) {
    return number(0.01 * (i / 2)) + "," + number(0.01 * (i / 2)) + "," + number(0.5 * (i / 2));
  });
  const ImportedTable table = imported(twice);
  EXPECT_EQ(table.recording.rows.size(), 200u);
  EXPECT_TRUE(test::has_parts(all_notes(table), {"left out 200 rows"}));
}

TEST(ForeignRows, ACoarseClockWithoutAUnitIsAmbiguous) {
  const auto text = table_of("time,pos (mm),force (N)", 400, [](int i) {
    return std::to_string(i / 10) + "," + number(0.01 * i) + "," + number(0.5 * i);
  });
  EXPECT_TRUE(test::has_parts(message(text), {"\"time\"", "--units s or --units ms"}));
}

TEST(ForeignRows, ASecondRecordingInTheFileIsSplitAndNotJoined) {
  const std::string header = "time (s),pos (mm),force (N)";
  const auto row = [](int i) { return number(0.01 * i) + "," + number(0.01 * i) + "," + number(0.5 * i); };
  const std::string one = table_of(header, 100, row);
  const std::string stacked = one + one.substr(header.size() + 1);
  EXPECT_TRUE(test::has_parts(message(stacked), {"rig.txt:102: ", "0.99 s before", "split the file at this line"}));
  EXPECT_EQ(message(stacked).find("--rate"), std::string::npos);
  EXPECT_TRUE(test::has_parts(message(one + "\n" + one), {"rig.txt:103: ", "the header again", "split the file"}));
  EXPECT_TRUE(test::has_parts(
      message(table_of("Specimen;" + std::string("t (s);pos (mm);F (N)"), 300,
                       [](int i) { return std::to_string(i / 150) + ";" + number(5.0 + 0.01 * (i % 150)) + ";1;2"; })),
      {"rig.txt:152: ", "split the file at this line"}));
  ImportRequest request;
  request.rate_Hz = 100.0;
  EXPECT_TRUE(test::has_parts(all_notes(imported(stacked, request)), {"warning", "line 102", "split the file"}));
}

}  // namespace
}  // namespace palpate
