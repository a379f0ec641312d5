// Tables in the formats of rigs, each with the same press.
#include "engine/import/import_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

const std::string kFiles = std::string(PALPATE_SOURCE_DIR) + "/tests/engine/import/files";

RecordingRow press_row(std::size_t i) {
  RecordingRow row;
  row.time_s = 0.02 * static_cast<double>(i);
  const double d = 4.0 * std::sin(std::numbers::pi * row.time_s / 0.48) - 1.0;
  row.position_m = 1e-3 * d;
  row.force_N = d > 0.0 ? 0.4 * d + 0.05 * d * d : 0.0;
  return row;
}

ImportRequest request(const RoleRequest& columns, std::initializer_list<const char*> units = {}, double rate_Hz = 0.0) {
  ImportRequest made;
  made.columns = columns;
  for (const char* unit : units) made.units.push_back(*find_unit(unit));
  if (rate_Hz > 0.0) made.rate_Hz = rate_Hz;
  return made;
}

// The options that files need; the others need none.
std::map<std::string, ImportRequest> rig_requests() {
  std::map<std::string, ImportRequest> requests = {
      {"01_labview.lvm", request({}, {"mm", "N"})},
      {"03_rostopic.csv", request({"", "", "field.wrench.force.z"}, {"m", "N"})},
      {"04_ros2bag.csv", request({}, {"N"})},
      {"09_arduino.txt", request({"1", "2", "3"}, {"ms", "mm", "g"})},
      {"10_ati.csv", request({"", "", "4"})},
      {"19_rate.csv", request({}, {}, 50.0)},
      {"20_bare.txt", request({"1", "2", "3"}, {"s", "mm", "N"})},
  };
  requests["10_ati.csv"].flip_force = true;         // the axis of the sensor points inward
  requests["22_outward.csv"].flip_position = true;  // a height above the table
  return requests;
}

TEST(ImportTable, ReadsTheSamePressFromEveryRig) {
  auto requests = rig_requests();
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFiles)) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md") continue;
    SCOPED_TRACE(name);
    ++files;
    const auto table = import_table(entry.path().string(), requests[name]);
    ASSERT_TRUE(table.ok()) << table.error().message;
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

std::string rows_of(const std::string& separator, int count = 12) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "0.0" + std::to_string(10 + i) + separator + "0.5" + separator + std::to_string(i) + ".25\n";
  }
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

bool notes_have(const ImportedTable& table, const std::string& text) {
  return std::any_of(table.notes.begin(), table.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

TEST(ImportTable, SaysWhatIsAmbiguousAndWhatToAdd) {
  EXPECT_TRUE(test::has_parts(message("t [s],pos,Fz [N]\n" + rows_of(",")),
                              {"rig.txt", "\"pos\"", "--units mm", "--units mm,N"}));
  EXPECT_TRUE(test::has_parts(message("t [s],pos [mm],Fx [N],Fy [N],Fz [N]\n" + rows_of(",1,")),
                              {"rig.txt", "3 columns", "--columns force=3", "--columns force=4", "--columns force=5",
                               "1 \"t [s]\"", "2 \"pos [mm]\"", "3 \"Fx [N]\"", "4 \"Fy [N]\"", "5 \"Fz [N]\""}));
  EXPECT_TRUE(test::has_parts(message(rows_of(",")), {"rig.txt", "no header", "--columns time=1,position=2,force=3",
                                                      "--rate HZ", "1 \"0.010\"", "2 \"0.5\"", "3 \"0.25\""}));
  EXPECT_TRUE(test::has_parts(message("t [s],pos [mm],F [N]\n" + rows_of(","), request({"", "weg", ""})),
                              {"rig.txt", "\"weg\"", "1 \"t [s]\"", "2 \"pos [mm]\"", "3 \"F [N]\""}));
}

TEST(ImportTable, SaysWhatIsBrokenAndWhere) {
  EXPECT_TRUE(test::has_parts(message(""), {"rig.txt", "empty", "; "}));
  EXPECT_TRUE(test::has_parts(message("PK\x03\x04rest"), {"rig.txt", "Excel", "; "}));
  EXPECT_TRUE(test::has_parts(message("only words\nand more\n"), {"rig.txt", "2 lines", "; "}));
  const std::string header = "t [s],pos [mm],F [N]\n";
  EXPECT_TRUE(test::has_parts(message(header + rows_of(",") + "0.030,oops,1\n0.040,0.5,1\n"),
                              {"rig.txt:14: ", "\"oops\" in column 2 \"pos [mm]\"", "position", "--skip-bad-rows N"}));
  EXPECT_TRUE(test::has_parts(message(header + rows_of(",") + "0.020,0.5,1\n"),
                              {"rig.txt:14:", "0.001 s", "\"t [s]\"", "--rate 1000"}));
  EXPECT_TRUE(test::has_parts(message(header + rows_of(",", 4)), {"rig.txt", "4 rows", "10", "; "}));
}

// With a rate, a row whose own time cannot be read counts; the duration of the others is compared.
TEST(ImportTable, ARateIsComparedWithTheTimesThatCanBeRead) {
  std::string text = "t [s],pos [mm],F [N]\n";
  for (int i = 0; i < 100; ++i) text += (i < 99 ? std::to_string(0.01 * i) : "") + ",0.5,1\n";
  EXPECT_FALSE(notes_have(imported(text, request({}, {}, 100.0)), "by the times"));
}

TEST(ImportTable, ShiftsTheTimeAndSaysSo) {
  const ImportedTable table = imported("t [s],pos [mm],F [N]\n" + rows_of(","));
  EXPECT_EQ(table.recording.rows.front().time_s, 0.0);
  EXPECT_TRUE(notes_have(table, "0.01 s"));
}

TEST(ImportTable, KeepsTheFirstOfRowsWithOneTime) {
  const ImportedTable table = imported("t [s],pos [mm],F [N]\n" + rows_of(",") + "0.021,0.7,9\n0.022,0.5,1\n");
  ASSERT_EQ(table.recording.rows.size(), 13u);
  EXPECT_NEAR(table.recording.rows[11].position_m, 0.5e-3, 1e-12);
  EXPECT_TRUE(notes_have(table, "1 row with the time of the previous row"));
}

TEST(ImportTable, ComparesARateWithTheTimesOfTheFile) {
  const std::string text = "t [s],pos [mm],F [N]\n" + rows_of(",");
  EXPECT_TRUE(notes_have(imported(text, request({}, {}, 500.0)), "0.011 s by the times in the file"));
  EXPECT_FALSE(notes_have(imported(text, request({}, {}, 1000.0)), "by the times in the file"));
}

TEST(ImportTable, KnowsUnitsAndNamesOfManyPrograms) {
  const auto last_row = [](const std::string& head) { return imported(head + rows_of(",")).recording.rows.back(); };
  EXPECT_NEAR(last_row("Time,Extension,Load\n(s),(mm),(N)\n").position_m, 0.5e-3, 1e-12);
  EXPECT_NEAR(last_row("time (s),displacement (in),load (kip)\n").position_m, 12.7e-3, 1e-9);
  EXPECT_NEAR(last_row("time (s),displacement (mm),load (kip)\n").force_N, 11.25 * 4448.2216, 0.1);
  EXPECT_NEAR(last_row("time (s),displacement (mm),load (kgf)\n").force_N, 11.25 * 9.80665, 1e-6);
  EXPECT_NEAR(last_row("time (s),displacement (mm),load (lbf)\n").force_N, 11.25 * 4.4482216, 1e-5);
  for (const char* head :
       {"Zeit [s],Traversenweg [mm],Standardkraft [N]\n", "Tiempo (s),Desplazamiento (mm),Fuerza (N)\n",
        "temps (s),d\xC3\xA9placement (mm),effort (N)\n",
        "time_history (s),displacement_history (mm),force_history (N)\n",
        "\xE6\x97\xB6\xE9\x97\xB4(s),\xE4\xBD\x8D\xE7\xA7\xBB(mm),\xE5\x8A\x9B(N)\n"}) {
    EXPECT_NEAR(last_row(head).position_m, 0.5e-3, 1e-12) << head;
    EXPECT_EQ(last_row(head).force_N, 11.25) << head;
  }
}

TEST(ImportTable, AConstantColumnIsNoTime) {
  std::string text = "time,t2 [s],pos [mm],F [N]\n";
  for (int i = 0; i < 12; ++i) text += "5,0.0" + std::to_string(10 + i) + ",0.5," + std::to_string(i) + "\n";
  EXPECT_EQ(imported(text, request({"", "", ""})).columns[0].number, 2u);
}

TEST(ImportTable, ReadsAMeasuredVelocity) {
  const auto table = [](double factor) {
    std::string text = "t [s],pos [mm],F [N],Speed (mm/s)\n";
    for (int i = 0; i < 40; ++i) {
      const double t = 0.01 * i;
      for (const double value : {t, 3.0 * t * t, 1.0 + t, factor * 6.0 * t}) text += std::to_string(value) + ",";
      text.back() = '\n';
    }
    return imported(text);
  };
  const ImportedTable good = table(1.0);
  EXPECT_TRUE(good.recording.columns.velocity);
  EXPECT_NEAR(good.recording.rows[20].velocity_m_per_s, 1.2e-3, 1e-8);
  EXPECT_FALSE(table(-1.0).recording.columns.velocity);  // not the rate of the position
}

}  // namespace
}  // namespace palpate
